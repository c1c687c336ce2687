#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <stdexcept>
#include <vector>

#include <opencv2/core.hpp>

#include "reconstruct/bricks/block_pool.hpp"
#include "reconstruct/bricks/brick_cells.hpp"
#include "reconstruct/bricks/brick_source.hpp"
#include "reconstruct/bricks/texel_blocks.hpp"
#include "reconstruct/store/pyramid.hpp"
#include "tests/reconstruct/volume_levels.hpp"

namespace biotomy::tests {

/// A volume in memory. Knobs, to be turned before its levels are asked for: its shape, its colours,
/// how many layers there are, which chunks were never written, whether it has coarser levels.
struct MemorySource final : reconstruct::BrickSource {
  reconstruct::Cuboid box{{40, 30, 20}, {10.0, 10.0, 10.0}};
  std::array<int, 3> chunk_size{8, 8, 8};  ///< z, y, x
  int bit_count = 8;
  bool pyramid = false;        ///< the coarser levels, too, that a store of it would have
  std::optional<int> present;  ///< layers, unless all of them; at least 1
  /// The level of colour c at voxel (x, y, z).
  std::function<int(int x, int y, int z, int c)> voxel = [](int, int, int, int) { return 0; };
  std::set<reconstruct::ChunkIndex> never_written;
  bool broken = false;
  std::size_t capacity = std::size_t{1} << 30;

  std::multiset<reconstruct::ChunkIndex> asked;  ///< every chunk that was fetched, of any level

  const reconstruct::Cuboid& cuboid() const override { return box; }
  std::array<int, 3> brick_shape() const override { return chunk_size; }
  int bits() const override { return bit_count; }
  int levels() const override { return static_cast<int>(all_levels().size()); }
  const reconstruct::PyramidLevel& level(int number) const override {
    return all_levels().at(static_cast<std::size_t>(number));
  }
  std::int64_t layers_present() const override { return present.value_or(box.size.z); }
  std::size_t capacity_bytes() const override { return capacity; }
  void expect(int /*level*/, std::span<const reconstruct::ChunkIndex> /*soon*/,
              const reconstruct::PlaneReach& /*plane*/) override {}

  /// Texels that are not near the plane are what must never be seen.
  std::vector<reconstruct::TexelBrick> bricks(int level,
                                              std::span<const reconstruct::ChunkIndex> wanted,
                                              const reconstruct::PlaneReach& plane) override {
    const reconstruct::BrickCells cells(chunk_size);
    const reconstruct::CellsNearPlane near(cells, chunk_size, plane);
    std::vector<reconstruct::TexelBrick> result;
    for (const reconstruct::ChunkIndex& index : wanted) {
      result.push_back(brick(level, index, cells, near.of(index)));
    }
    return result;
  }

  int most() const { return bit_count == 8 ? 255 : 65535; }

  /// The level of colour c at a voxel of a level; those of coarser levels are means of the level
  /// before, as the store defines them. 0 where no layer is present.
  int voxel_of(int level, int x, int y, int z, int c) {
    if (level == 0) {
      return z < layers_present() ? voxel(x, y, z, c) : 0;
    }
    const Layers& layers = layers_of(level);
    return z < static_cast<int>(layers.size()) ? value(layers, x, y, z, c) : 0;
  }

 private:
  using Layers = std::vector<cv::Mat>;

  // Once; the sampler asks from many threads.
  const std::vector<reconstruct::PyramidLevel>& all_levels() const {
    const std::scoped_lock lock(levels_mutex_);
    if (levels_.empty()) {
      const std::vector<reconstruct::LevelFactor> factors =
          pyramid ? reconstruct::pyramid_factors(box, chunk_size)
                  : std::vector<reconstruct::LevelFactor>{{}};
      for (const reconstruct::LevelFactor& factor : factors) {
        levels_.push_back(reconstruct::pyramid_level(box, factor));
      }
    }
    return levels_;
  }

  const Layers& layers_of(int number) {
    if (means_.empty()) {
      means_.push_back(finest_layers());
    }
    while (static_cast<int>(means_.size()) <= number) {
      const auto next = static_cast<int>(means_.size());
      means_.push_back(reconstruct::slow_next_level(means_.back(), level(next - 1), level(next)));
    }
    return means_[static_cast<std::size_t>(number)];
  }

  Layers finest_layers() const {
    Layers layers;
    for (int z = 0; z < layers_present(); ++z) {
      layers.emplace_back(static_cast<int>(box.size.y), static_cast<int>(box.size.x),
                          bit_count == 8 ? CV_8UC3 : CV_16UC3);
      for (int y = 0; y < box.size.y; ++y) {
        for (int x = 0; x < box.size.x; ++x) {
          for (int c = 0; c < 3; ++c) {
            if (bit_count == 8) {
              layers.back().at<cv::Vec3b>(y, x)[c] = static_cast<std::uint8_t>(voxel(x, y, z, c));
            } else {
              layers.back().at<cv::Vec3w>(y, x)[c] = static_cast<std::uint16_t>(voxel(x, y, z, c));
            }
          }
        }
      }
    }
    return layers;
  }

  int value(const Layers& layers, int x, int y, int z, int c) const {
    const cv::Mat& layer = layers[static_cast<std::size_t>(z)];
    return bit_count == 8 ? layer.at<cv::Vec3b>(y, x)[c] : layer.at<cv::Vec3w>(y, x)[c];
  }

  reconstruct::TexelBrick brick(int number, const reconstruct::ChunkIndex& index,
                                const reconstruct::BrickCells& cells, reconstruct::CellSet near) {
    const std::scoped_lock lock(mutex_);
    asked.insert(index);
    if (broken) {
      throw std::runtime_error("the chunk is damaged");
    }
    if (never_written.contains(index)) {
      return nullptr;
    }
    reconstruct::ChunkVoxels voxels;
    for (int z = 0; z < chunk_size[0]; ++z) {
      for (int y = 0; y < chunk_size[1]; ++y) {
        for (int x = 0; x < chunk_size[2]; ++x) {
          append_voxel(voxels, number, index.x * chunk_size[2] + x, index.y * chunk_size[1] + y,
                       index.z * chunk_size[0] + z);
        }
      }
    }
    const reconstruct::TexelBlocks blocks(chunk_size, bit_count);
    auto texels =
        reconstruct::BlockPool(blocks.brick_bytes(), reconstruct::TexelBlocks::slack()).allocate();
    std::fill_n(texels.get(), blocks.brick_bytes(), std::byte{0xA5});
    cells.for_each_box(near, [&](const auto& part) { blocks.lay_out(voxels, part, texels.get()); });
    return texels;
  }

  // Beyond the volume chunks hold what must never be seen.
  void append_voxel(reconstruct::ChunkVoxels& voxels, int number, int x, int y, int z) {
    const reconstruct::GridSize& size = level(number).size;
    const bool inside = x < size.x && y < size.y && z < size.z;
    for (int c = 0; c < 3; ++c) {
      const auto level = static_cast<unsigned>(inside ? voxel_of(number, x, y, z, c) : most());
      voxels.push_back(static_cast<std::byte>(level & 255U));
      if (bit_count == 16) {
        voxels.push_back(static_cast<std::byte>(level >> 8U));
      }
    }
  }

  std::mutex mutex_;
  mutable std::mutex levels_mutex_;
  mutable std::vector<reconstruct::PyramidLevel> levels_;
  std::vector<Layers> means_;
};

/// Noise that is the same on every run: neighbours have nothing in common, so that any voxel taken
/// for another shows.
inline std::function<int(int, int, int, int)> noise(const reconstruct::GridSize& size, int most,
                                                    unsigned seed) {
  auto levels = std::make_shared<std::vector<int>>();
  std::mt19937 random(seed);
  for (std::int64_t i = 0; i < size.x * size.y * size.z * 3; ++i) {
    levels->push_back(static_cast<int>(random() % static_cast<unsigned>(most + 1)));
  }
  return [levels, size](int x, int y, int z, int c) {
    return (*levels)[static_cast<std::size_t>(((z * size.y + y) * size.x + x) * 3 + c)];
  };
}

}  // namespace biotomy::tests
