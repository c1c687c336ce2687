#include "reconstruct/section/sampler.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <opencv2/core.hpp>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "reconstruct/section/chunk_window.hpp"
#include "reconstruct/section/linear_kernel.hpp"
#include "reconstruct/section/nearest_kernel.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr int kLargestTile = 128;       // pixels along a side
constexpr double kWindowChunks = 4096;  // a tile's table stays in the nearest cache levels

// What one thread has gathered; united when all tiles are done.
struct Gathered {
  std::vector<ChunkIndex> touched;
  std::chrono::nanoseconds sampling{0};
};

struct Tile {
  ColumnRange columns;
  int first_row = 0;
  int last_row = 0;  // the one after the last
};

double step_between(const VoxelRow& a, const VoxelRow& b, std::size_t axis) {
  return std::abs(b.start[axis] - a.start[axis]);
}

// Halved until the chunks around a tile make a small table, however many voxels a pixel spans.
int tile_side(const PixelGrid& grid, const ChunkSource& source) {
  const VoxelRow row = voxel_row(grid, source.cuboid(), 0);
  const VoxelRow next = voxel_row(grid, source.cuboid(), 1);
  const std::array<int, 3> shape = source.chunk_shape();
  for (int side = kLargestTile; side > 1; side /= 2) {
    double chunks = 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double voxels = side * (std::abs(row.step[axis]) + step_between(row, next, axis)) + 2.0;
      chunks *= voxels / shape[2 - axis] + 2.0;
    }
    if (chunks <= kWindowChunks) {
      return side;
    }
  }
  return 1;
}

template <typename Level>
void fill(Level* out, int count, const std::array<Level, 3>& colour) {
  for (int i = 0; i < count; ++i, out += 3) {
    std::copy(colour.begin(), colour.end(), out);
  }
}

template <template <typename> class Kernel, typename Level>
class TileSampler {
 public:
  TileSampler(ChunkSource& source, const PixelGrid& grid, const Colour& background, cv::Mat& image)
      : source_(source), grid_(grid), image_(image) {
    const GridSize& size = source.cuboid().size;
    last_ = {static_cast<int>(size.x - 1), static_cast<int>(size.y - 1),
             static_cast<int>(size.z - 1)};
    const int scale = sizeof(Level) == 1 ? 1 : 257;
    for (std::size_t colour = 0; colour < 3; ++colour) {
      background_[colour] = static_cast<Level>(background[colour] * scale);
    }
  }

  void sample(const Tile& tile, Gathered& gathered) const {
    const auto start = std::chrono::steady_clock::now();
    std::vector<VoxelRow> rows;
    std::vector<ColumnRange> inside;
    for (int v = tile.first_row; v < tile.last_row; ++v) {
      rows.push_back(voxel_row(grid_, source_.cuboid(), v));
      inside.push_back(columns_inside(rows.back(), tile.columns, source_.cuboid().size));
    }
    ChunkWindow window(source_, box_around(rows, inside));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      Level* out = image_.ptr<Level>(tile.first_row + static_cast<int>(i));
      fill(out + 3 * std::ptrdiff_t{tile.columns.first}, inside[i].first - tile.columns.first,
           background_);
      Kernel<Level>::sample_row(rows[i], inside[i], last_, window,
                                out + 3 * std::ptrdiff_t{inside[i].first});
      fill(out + 3 * std::ptrdiff_t{inside[i].last}, tile.columns.last - inside[i].last,
           background_);
    }
    gathered.touched.insert(gathered.touched.end(), window.touched().begin(),
                            window.touched().end());
    gathered.sampling += std::chrono::steady_clock::now() - start - window.time_fetching();
  }

 private:
  // The voxels that the kernels may ask for: those around the pixels and one more on each side.
  VoxelBox box_around(const std::vector<VoxelRow>& rows,
                      const std::vector<ColumnRange>& inside) const {
    VoxelBox box{last_, {0, 0, 0}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (inside[i].first == inside[i].last) {
        continue;
      }
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double first = rows[i].at(axis, inside[i].first);
        const double last = rows[i].at(axis, inside[i].last - 1);
        const int low = static_cast<int>(std::floor(std::min(first, last))) - 1;
        const int high = static_cast<int>(std::floor(std::max(first, last))) + 2;
        box.first[a] = std::min(box.first[a], std::clamp(low, 0, last_[a]));
        box.last[a] = std::max(box.last[a], std::clamp(high, 0, last_[a]));
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.first[axis] = std::min(box.first[axis], box.last[axis]);
    }
    return box;
  }

  ChunkSource& source_;
  const PixelGrid& grid_;
  cv::Mat& image_;
  std::array<int, 3> last_{};
  std::array<Level, 3> background_{};
};

std::vector<Tile> tiles_of(const PixelGrid& grid, int side) {
  std::vector<Tile> tiles;
  for (int row = 0; row < grid.rows; row += side) {
    for (int column = 0; column < grid.columns; column += side) {
      tiles.push_back(
          {{column, std::min(column + side, grid.columns)}, row, std::min(row + side, grid.rows)});
    }
  }
  return tiles;
}

std::int64_t count_different(std::vector<ChunkIndex>& chunks) {
  std::sort(chunks.begin(), chunks.end());
  return std::unique(chunks.begin(), chunks.end()) - chunks.begin();
}

template <template <typename> class Kernel, typename Level>
SampleStatistics sample_tiles(ChunkSource& source, const PixelGrid& grid, const Colour& background,
                              cv::Mat& image) {
  const TileSampler<Kernel, Level> sampler(source, grid, background, image);
  const std::vector<Tile> tiles = tiles_of(grid, tile_side(grid, source));
  tbb::enumerable_thread_specific<Gathered> gathered;
  tbb::parallel_for(std::size_t{0}, tiles.size(),
                    [&](std::size_t i) { sampler.sample(tiles[i], gathered.local()); });
  std::vector<ChunkIndex> touched;
  SampleStatistics statistics;
  for (const Gathered& part : gathered) {
    touched.insert(touched.end(), part.touched.begin(), part.touched.end());
    statistics.sample_s += std::chrono::duration<double>(part.sampling).count();
  }
  statistics.chunks_touched = count_different(touched);
  return statistics;
}

template <typename Level>
SampleStatistics sample_with(Interpolation kind, ChunkSource& source, const PixelGrid& grid,
                             const Colour& background, cv::Mat& image) {
  switch (kind) {
    case Interpolation::nearest:
      return sample_tiles<NearestKernel, Level>(source, grid, background, image);
    case Interpolation::linear:
      break;
  }
  return sample_tiles<LinearKernel, Level>(source, grid, background, image);
}

}  // namespace

SampledImage sample_grid(ChunkSource& source, const PixelGrid& grid, Interpolation kind,
                         const Colour& background) {
  const bool deep = source.bits() == 16;
  SampledImage result{cv::Mat(grid.rows, grid.columns, deep ? CV_16UC3 : CV_8UC3), {}};
  result.statistics = deep
                          ? sample_with<std::uint16_t>(kind, source, grid, background, result.image)
                          : sample_with<std::uint8_t>(kind, source, grid, background, result.image);
  return result;
}

}  // namespace biotomy::reconstruct
