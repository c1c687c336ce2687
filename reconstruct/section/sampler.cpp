#include "reconstruct/section/sampler.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include "reconstruct/section/level_choice.hpp"
#include "reconstruct/section/tile_plan.hpp"
#include "reconstruct/section/tile_sampler.hpp"
#include "reconstruct/whole_loop.hpp"

namespace biotomy::reconstruct {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTileColumns = kMostPixels;
constexpr int kTileColumnsOf16Bits =
    32;  // so that what the steps' rounding adds up stays below a level
constexpr int kTileRows = 64;
constexpr int kStripRows = 128;
constexpr int kLeastStripRows = 8;
constexpr std::size_t kStripsPlanned = 4;  // and announced: more keep a disk busier, warm they cost
constexpr double kBoxBricks = 4096;        // a tile's table stays in the nearest cache levels

double step_between(const VoxelRow& a, const VoxelRow& b, std::size_t axis) {
  return std::abs(b.start[axis] - a.start[axis]);
}

/// Rows and columns of tiles, halved until the bricks around a tile make a small table, and a row's
/// positions in a tile can be counted, however many voxels a pixel spans.
cv::Size tile_size(const BrickSource& source, int level, const PixelGrid& grid) {
  const VoxelRow row = voxel_row(grid, source.level(level), 0);
  const VoxelRow next = voxel_row(grid, source.level(level), 1);
  const std::array<int, 3> shape = source.brick_shape();
  cv::Size size(source.bits() == 16 ? kTileColumnsOf16Bits : kTileColumns, kTileRows);
  for (; size.area() > 1; size = {std::max(size.width / 2, 1), std::max(size.height / 2, 1)}) {
    double bricks = 1.0;
    bool counts = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double voxels =
          size.width * std::abs(row.step[axis]) + size.height * step_between(row, next, axis) + 4.0;
      bricks *= voxels / shape[2 - axis] + 2.0;
      counts = counts && size.width * std::abs(row.step[axis]) < kMostVoxels;
    }
    if (bricks <= kBoxBricks && counts) {
      break;
    }
  }
  return size;
}

template <typename Level>
std::array<Level, 3> levels_of(const Colour& colour) {
  constexpr int kScale = sizeof(Level) == 1 ? 1 : 257;
  std::array<Level, 3> levels{};
  for (std::size_t i = 0; i < levels.size(); ++i) {
    levels[i] = static_cast<Level>(colour[i] * kScale);
  }
  return levels;
}

/// From the first to behind the last of `columns` that has a pixel of `rows` in the cuboid; of
/// those columns that are seen by no row, none.
ColumnRange columns_with_pixels(std::span<const PictureRow> rows, const ColumnRange& columns) {
  ColumnRange seen{columns.last, columns.first};
  for (const PictureRow& row : rows) {
    const int first = std::max(row.inside.first, columns.first);
    const int last = std::min(row.inside.last, columns.last);
    if (first < last) {
      seen = {std::min(seen.first, first), std::max(seen.last, last)};
    }
  }
  return seen.first < seen.last ? seen : ColumnRange{columns.first, columns.first};
}

/// A level of the pyramid, and how much of it the picture takes: all of the finest one, into which
/// so much of the next is mixed.
struct LevelPart {
  int level = 0;
  double part = 1.0;
};

std::vector<LevelPart> level_parts(const LevelChoice& choice) {
  std::vector<LevelPart> parts{{choice.finer, 1.0}};
  if (choice.part > 0.0) {
    parts.push_back({choice.coarser, choice.part});
  }
  return parts;
}

/// Some rows of the picture, and all that sampling them from one level needs.
struct Strip {
  LevelPart from;
  int first_row = 0;
  int last_row = 0;
  std::vector<TilePlan> tiles;
  std::vector<Tile> outside;        ///< without any pixel in the cuboid, of any width
  std::vector<ChunkIndex> indices;  ///< of the bricks of all tiles, sorted, each once
  std::vector<TexelBrick> bricks;   ///< those, once they are fetched
};

/// Samples strip by strip, one level after the other. While a strip is sampled the next one's
/// bricks are read and decoded, and those of one further down are found and announced: so threads
/// need not wait for each other, nor for the disk.
template <typename Level>
class PictureSampler {
 public:
  PictureSampler(BrickSource& source, const PixelGrid& grid, Interpolation kind,
                 const Colour& background, const OnRows& on_rows)
      : source_(source),
        grid_(grid),
        kind_(kind),
        on_rows_(on_rows),
        background_(background),
        levels_(level_parts(level_choice(source, grid, kind))),
        samplers_([kind, colour = levels_of<Level>(background)] {
          return TileSampler<Level>(kind, colour);
        }) {}

  SampleStatistics sample(cv::Mat& image) {
    image.create(grid_.rows, grid_.columns, sizeof(Level) == 1 ? CV_8UC3 : CV_16UC3);
    std::deque<Strip> strips;
    while (std::optional<Strip> strip = next_strip()) {
      strips.push_back(*std::move(strip));
      if (strips.size() == kStripsPlanned) {
        break;
      }
    }
    if (!strips.empty()) {
      fetch(strips.front());
    }
    std::int64_t rows = 0;
    while (!strips.empty()) {
      std::optional<Strip> further;
      tbb::parallel_invoke([&] { fill(strips.front(), image); },
                           [&] {
                             if (strips.size() > 1) {
                               fetch(strips[1]);
                             }
                           },
                           [&] { further = next_strip(); });
      rows += strips.front().last_row - strips.front().first_row;
      if (on_rows_) {
        on_rows_(rows, std::int64_t{grid_.rows} * std::ssize(levels_));
      }
      strips.pop_front();
      if (further) {
        strips.push_back(*std::move(further));
      }
    }
    count_touched();
    SampleStatistics statistics;
    statistics.chunks_touched = chunks_touched_;
    for (const LevelPart& each : levels_) {
      statistics.levels.push_back(each.level);
    }
    statistics.sample_s = 1e-9 * static_cast<double>(sampling_ns_.load());
    return statistics;
  }

 private:
  /// Plans and announces the strip below the one that was planned last, or the first one of the
  /// next level; none at the end.
  std::optional<Strip> next_strip() {
    if (next_row_ == grid_.rows) {
      next_row_ = 0;
      ++next_level_;
    }
    if (next_level_ == levels_.size() || grid_.rows == 0) {
      return std::nullopt;
    }
    const LevelPart& from = levels_[next_level_];
    const cv::Size tile = tile_size(source_, from.level, grid_);
    if (next_row_ == 0) {
      rows_ = std::max(kStripRows / tile.height, 1) * tile.height;
    }
    std::optional<Strip> strip;
    for (;;) {
      strip = plan_strip(from, tile);
      if (fits(*strip) || rows_ <= kLeastStripRows) {
        break;
      }
      rows_ = std::max(rows_ / 2, kLeastStripRows);
    }
    next_row_ = strip->last_row;
    source_.expect(from.level, strip->indices, plane_at(from.level));
    return strip;
  }

  /// Two strips' bricks are needed at a time.
  bool fits(const Strip& strip) const {
    return strip.indices.size() *
               TexelBlocks(source_.brick_shape(), source_.bits()).brick_bytes() <=
           source_.capacity_bytes() / 2;
  }

  std::vector<PictureRow> rows_of(const Strip& strip) const {
    std::vector<PictureRow> rows(static_cast<std::size_t>(strip.last_row - strip.first_row));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i] = PictureRow(source_, strip.from.level, grid_, strip.first_row + static_cast<int>(i));
    }
    return rows;
  }

  /// Cuts `rows`, which begin with row `first_row`, into tiles. Only those with a pixel in the
  /// cuboid are given, to be planned; however wide a picture is, the others cost next to nothing.
  std::vector<Tile> tiles_of(std::span<const PictureRow> rows, int first_row, const cv::Size& tile,
                             std::vector<Tile>& outside) const {
    const int last_row = first_row + static_cast<int>(rows.size());
    const ColumnRange inside = columns_with_pixels(rows, {0, grid_.columns});
    const int first = inside.first / tile.width * tile.width;
    std::vector<Tile> tiles;
    int column = first;
    for (; column < inside.last; column += tile.width) {
      const ColumnRange columns{column, std::min(column + tile.width, grid_.columns)};
      const ColumnRange seen = columns_with_pixels(rows, columns);
      (seen.first < seen.last ? tiles : outside).push_back({columns, first_row, last_row});
    }
    outside.push_back({{0, first}, first_row, last_row});
    outside.push_back({{std::min(column, grid_.columns), grid_.columns}, first_row, last_row});
    return tiles;
  }

  Strip plan_strip(const LevelPart& from, const cv::Size& tile) {
    Strip strip{from, next_row_, std::min(next_row_ + rows_, grid_.rows), {}, {}, {}, {}};
    const std::vector<PictureRow> rows = rows_of(strip);
    const auto rows_from = [&](int first, int last) {
      return std::span(rows).subspan(static_cast<std::size_t>(first - strip.first_row),
                                     static_cast<std::size_t>(last - first));
    };
    std::vector<Tile> tiles;
    for (int row = strip.first_row; row < strip.last_row; row += tile.height) {
      const auto band = rows_from(row, std::min(row + tile.height, strip.last_row));
      const std::vector<Tile> of_band = tiles_of(band, row, tile, strip.outside);
      tiles.insert(tiles.end(), of_band.begin(), of_band.end());
    }
    std::vector<std::optional<TilePlan>> plans(tiles.size());
    // A whole loop, also when the strip that is fetched meanwhile cannot be read.
    whole_loop(tiles.size(), [&](std::size_t i) {
      const auto start = Clock::now();
      const Tile& each = tiles[i];
      plans[i].emplace(source_, from.level, kind_, each, rows_from(each.first_row, each.last_row));
      count_time_since(start);
    });
    for (std::optional<TilePlan>& plan : plans) {
      strip.indices.insert(strip.indices.end(), plan->bricks().begin(), plan->bricks().end());
      strip.tiles.push_back(*std::move(plan));
    }
    std::sort(strip.indices.begin(), strip.indices.end());
    strip.indices.erase(std::unique(strip.indices.begin(), strip.indices.end()),
                        strip.indices.end());
    return strip;
  }

  PlaneReach plane_at(int level) const { return plane_reach(source_, level, grid_, kind_); }

  void fetch(Strip& strip) {
    strip.bricks = source_.bricks(strip.from.level, strip.indices, plane_at(strip.from.level));
    if (strip.first_row == 0) {
      count_touched();  // of the level before
    }
    touched_.insert(touched_.end(), strip.indices.begin(), strip.indices.end());
  }

  void count_touched() {
    std::sort(touched_.begin(), touched_.end());
    chunks_touched_ += std::unique(touched_.begin(), touched_.end()) - touched_.begin();
    touched_.clear();
  }

  /// The strip's rows of the picture.
  void fill(const Strip& strip, cv::Mat& picture) {
    if (strip.from.part == 1.0) {
      sample_tiles(strip, 0, picture);
      return;
    }
    cv::Mat coarse(strip.last_row - strip.first_row, picture.cols, picture.type());
    sample_tiles(strip, strip.first_row, coarse);
    cv::Mat rows = picture.rowRange(strip.first_row, strip.last_row);
    cv::addWeighted(rows, 1.0 - strip.from.part, coarse, strip.from.part, 0.0, rows);
  }

  void sample_tiles(const Strip& strip, int first_row, cv::Mat& picture) {
    const std::array<Level, 3> colour = levels_of<Level>(background_);
    for (const Tile& tile : strip.outside) {
      picture(cv::Range(tile.first_row - first_row, tile.last_row - first_row),
              cv::Range(tile.columns.first, tile.columns.last))
          .setTo(cv::Scalar(colour[0], colour[1], colour[2]));
    }
    tbb::parallel_for(std::size_t{0}, strip.tiles.size(), [&](std::size_t i) {
      const auto start = Clock::now();
      const TilePlan& plan = strip.tiles[i];
      std::vector<const std::byte*> texels;
      texels.reserve(plan.bricks().size());
      for (const ChunkIndex& brick : plan.bricks()) {
        const auto place = std::lower_bound(strip.indices.begin(), strip.indices.end(), brick);
        texels.push_back(
            strip.bricks[static_cast<std::size_t>(place - strip.indices.begin())].get());
      }
      samplers_.local().fill(plan, texels, first_row, picture);
      count_time_since(start);
    });
  }

  void count_time_since(Clock::time_point start) {
    sampling_ns_ +=
        std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count();
  }

  BrickSource& source_;
  const PixelGrid& grid_;
  Interpolation kind_;
  const OnRows& on_rows_;
  Colour background_;
  std::vector<LevelPart> levels_;
  std::size_t next_level_ = 0;  // among levels_, of the strip that is planned next
  int next_row_ = 0;
  int rows_ = kStripRows;  // of a strip: as many as fit into memory
  tbb::enumerable_thread_specific<TileSampler<Level>> samplers_;
  std::vector<ChunkIndex>
      touched_;  // of the level at hand; neighbouring strips have some in common
  std::int64_t chunks_touched_ = 0;  // of all levels, each once
  std::atomic<std::int64_t> sampling_ns_{0};
};

}  // namespace

SampleStatistics sample_grid(BrickSource& source, const PixelGrid& grid, Interpolation kind,
                             const Colour& background, cv::Mat& image, const OnRows& on_rows) {
  return source.bits() == 16
             ? PictureSampler<std::uint16_t>(source, grid, kind, background, on_rows).sample(image)
             : PictureSampler<std::uint8_t>(source, grid, kind, background, on_rows).sample(image);
}

SampledImage sample_grid(BrickSource& source, const PixelGrid& grid, Interpolation kind,
                         const Colour& background, const OnRows& on_rows) {
  SampledImage sampled;
  sampled.statistics = sample_grid(source, grid, kind, background, sampled.image, on_rows);
  return sampled;
}

}  // namespace biotomy::reconstruct
