#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <random>
#include <set>
#include <span>
#include <stdexcept>
#include <vector>

#include "reconstruct/section/block_pool.hpp"
#include "reconstruct/section/brick_source.hpp"
#include "reconstruct/section/texel_blocks.hpp"

namespace biotomy::tests {

/// A volume in memory. Knobs: its shape, its colours, which chunks were never written.
struct MemorySource final : reconstruct::BrickSource {
  reconstruct::Cuboid box{{40, 30, 20}, {10.0, 10.0, 10.0}};
  std::array<int, 3> chunk_size{8, 8, 8};  ///< z, y, x
  int bit_count = 8;
  /// The level of colour c at voxel (x, y, z).
  std::function<int(int x, int y, int z, int c)> voxel = [](int, int, int, int) { return 0; };
  std::set<reconstruct::ChunkIndex> never_written;
  bool broken = false;

  std::multiset<reconstruct::ChunkIndex> asked;  ///< every chunk that was fetched
  std::mutex mutex;
  mutable reconstruct::PyramidLevel only_level;

  std::size_t capacity = std::size_t{1} << 30;

  const reconstruct::Cuboid& cuboid() const override { return box; }
  std::array<int, 3> brick_shape() const override { return chunk_size; }
  int bits() const override { return bit_count; }
  int levels() const override { return 1; }
  const reconstruct::PyramidLevel& level(int /*number*/) const override {
    only_level = reconstruct::pyramid_level(box, {});
    return only_level;
  }
  std::size_t capacity_bytes() const override { return capacity; }
  void expect(int /*level*/, std::span<const reconstruct::ChunkIndex> /*soon*/) override {}

  std::vector<reconstruct::TexelBrick> bricks(
      int /*level*/, std::span<const reconstruct::ChunkIndex> wanted) override {
    std::vector<reconstruct::TexelBrick> result;
    for (const reconstruct::ChunkIndex& index : wanted) {
      result.push_back(brick(index));
    }
    return result;
  }

  int most() const { return bit_count == 8 ? 255 : 65535; }

 private:
  reconstruct::TexelBrick brick(const reconstruct::ChunkIndex& index) {
    const std::scoped_lock lock(mutex);
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
          append_voxel(voxels, index.x * chunk_size[2] + x, index.y * chunk_size[1] + y,
                       index.z * chunk_size[0] + z);
        }
      }
    }
    const reconstruct::TexelBlocks blocks(chunk_size, bit_count);
    auto texels =
        reconstruct::BlockPool(blocks.brick_bytes(), reconstruct::TexelBlocks::slack()).allocate();
    blocks.lay_out(voxels, texels.get());
    return texels;
  }

  // Beyond the volume chunks hold what must never be seen.
  void append_voxel(reconstruct::ChunkVoxels& voxels, int x, int y, int z) const {
    const bool inside = x < box.size.x && y < box.size.y && z < box.size.z;
    for (int c = 0; c < 3; ++c) {
      const auto value = static_cast<unsigned>(inside ? voxel(x, y, z, c) : most());
      voxels.push_back(static_cast<std::byte>(value & 255U));
      if (bit_count == 16) {
        voxels.push_back(static_cast<std::byte>(value >> 8U));
      }
    }
  }
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
