#include "reconstruct/section/sampler.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "reconstruct/section/level_choice.hpp"
#include "reconstruct/section/tile_plan.hpp"
#include "reconstruct/section/tile_sampler.hpp"

namespace biotomy::reconstruct {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTileColumns = kMostPixels;
constexpr int kTileColumnsOf16Bits =
    32;  // so that what the steps' rounding adds up stays below a level
constexpr int kTileRows = 32;
constexpr int kStripRows = 64;
constexpr int kLeastStripRows = 8;
constexpr double kBoxBricks = 4096;  // a tile's table stays in the nearest cache levels

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
  for (; size.width > 1; size = {size.width / 2, std::max(size.height / 2, 1)}) {
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

/// Some rows of the picture, and all that sampling them from one level needs.
struct Strip {
  int level = 0;
  int first_row = 0;
  int last_row = 0;
  std::vector<TilePlan> tiles;
  std::vector<ChunkIndex> bricks;  ///< of all tiles, sorted, each once
};

/// Samples one level after another, strip by strip. While a strip's bricks are decoded and sampled,
/// those of the next have been announced, so that the disk is never waited for and never idle.
template <typename Level>
class PictureSampler {
 public:
  PictureSampler(BrickSource& source, const PixelGrid& grid, Interpolation kind,
                 const Colour& background, const OnRows& on_rows)
      : source_(source),
        grid_(grid),
        kind_(kind),
        on_rows_(on_rows),
        samplers_([kind, colour = levels_of<Level>(background)] {
          return TileSampler<Level>(kind, colour);
        }) {}

  SampleStatistics sample(cv::Mat& image) {
    const auto start = Clock::now();
    const LevelChoice levels = level_choice(source_, grid_.pixel, kind_);
    image.create(grid_.rows, grid_.columns, sizeof(Level) == 1 ? CV_8UC3 : CV_16UC3);
    SampleStatistics statistics;
    statistics.finest_level = levels.finer;
    statistics.levels = levels.part > 0.0 ? 2 : 1;
    rows_in_all_ = std::int64_t{grid_.rows} * statistics.levels;
    sample_level(levels.finer, 0.0, image);
    if (levels.part > 0.0) {
      sample_level(levels.finer + 1, levels.part, image);
    }
    statistics.chunks_touched = chunks_touched_;
    statistics.sample_s = std::chrono::duration<double>(Clock::now() - start - fetching_).count();
    return statistics;
  }

 private:
  /// Fills the picture when `part` is 0, else mixes so much of the level into it.
  void sample_level(int level, double part, cv::Mat& picture) {
    const cv::Size tile = tile_size(source_, level, grid_);
    rows_ = std::max(kStripRows / tile.height, 1) * tile.height;
    std::optional<Strip> next = plan_strip(level, 0, tile);
    while (next) {
      const Strip strip = *std::exchange(next, std::nullopt);
      if (strip.last_row < grid_.rows) {
        next = plan_strip(level, strip.last_row, tile);
        source_.expect(level, next->bricks);
      }
      if (part == 0.0) {
        sample_strip(strip, 0, picture);
      } else {
        cv::Mat coarse(strip.last_row - strip.first_row, picture.cols, picture.type());
        sample_strip(strip, strip.first_row, coarse);
        cv::Mat rows = picture.rowRange(strip.first_row, strip.last_row);
        cv::addWeighted(rows, 1.0 - part, coarse, part, 0.0, rows);
      }
      rows_done_ += strip.last_row - strip.first_row;
      if (on_rows_) {
        on_rows_(rows_done_, rows_in_all_);
      }
    }
    std::sort(touched_.begin(), touched_.end());
    chunks_touched_ += std::unique(touched_.begin(), touched_.end()) - touched_.begin();
    touched_.clear();
  }

  Strip plan_strip(int level, int first_row, const cv::Size& tile) {
    for (;;) {
      Strip strip{level, first_row, std::min(first_row + rows_, grid_.rows), {}, {}};
      std::vector<Tile> tiles;
      for (int row = strip.first_row; row < strip.last_row; row += tile.height) {
        for (int column = 0; column < grid_.columns; column += tile.width) {
          tiles.push_back({{column, std::min(column + tile.width, grid_.columns)},
                           row,
                           std::min(row + tile.height, strip.last_row)});
        }
      }
      std::vector<PictureRow> rows(static_cast<std::size_t>(strip.last_row - strip.first_row));
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows.size(), kTileRows),
                        [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i) {
                            rows[i] = PictureRow(source_, level, grid_,
                                                 strip.first_row + static_cast<int>(i));
                          }
                        });
      std::vector<std::optional<TilePlan>> plans(tiles.size());
      tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t i) {
        const Tile& each = tiles[i];
        plans[i].emplace(
            source_, level, kind_, each,
            std::span(rows).subspan(static_cast<std::size_t>(each.first_row - strip.first_row),
                                    static_cast<std::size_t>(each.last_row - each.first_row)));
      });
      for (std::optional<TilePlan>& plan : plans) {
        strip.bricks.insert(strip.bricks.end(), plan->bricks().begin(), plan->bricks().end());
        strip.tiles.push_back(*std::move(plan));
      }
      std::sort(strip.bricks.begin(), strip.bricks.end());
      strip.bricks.erase(std::unique(strip.bricks.begin(), strip.bricks.end()), strip.bricks.end());
      if (strip.bricks.size() * TexelBlocks(source_.brick_shape(), source_.bits()).brick_bytes() <=
              source_.capacity_bytes() / 2 ||
          rows_ <= kLeastStripRows) {
        return strip;
      }
      rows_ = std::max(rows_ / 2, kLeastStripRows);  // what a strip needs must fit into memory
    }
  }

  void sample_strip(const Strip& strip, int first_row, cv::Mat& picture) {
    const auto start = Clock::now();
    const std::vector<TexelBrick> bricks = source_.bricks(strip.level, strip.bricks);
    fetching_ += Clock::now() - start;
    touched_.insert(touched_.end(), strip.bricks.begin(), strip.bricks.end());
    tbb::parallel_for(std::size_t{0}, strip.tiles.size(), [&](std::size_t i) {
      const TilePlan& plan = strip.tiles[i];
      std::vector<const std::byte*> texels;
      texels.reserve(plan.bricks().size());
      for (const ChunkIndex& brick : plan.bricks()) {
        const auto place = std::lower_bound(strip.bricks.begin(), strip.bricks.end(), brick);
        texels.push_back(bricks[static_cast<std::size_t>(place - strip.bricks.begin())].get());
      }
      samplers_.local().fill(plan, texels, first_row, picture);
    });
  }

  BrickSource& source_;
  const PixelGrid& grid_;
  Interpolation kind_;
  const OnRows& on_rows_;
  std::int64_t rows_done_ = 0;
  std::int64_t rows_in_all_ = 0;
  int rows_ = kStripRows;  // of a strip
  tbb::enumerable_thread_specific<TileSampler<Level>> samplers_;
  std::vector<ChunkIndex>
      touched_;  // of the level at hand; neighbouring strips have some in common
  std::int64_t chunks_touched_ = 0;  // of all levels, each once
  Clock::duration fetching_{0};
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
