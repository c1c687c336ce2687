#include "reconstruct/bricks/texel_blocks.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

constexpr std::byte kUntouched{0xEE};

std::vector<std::array<int, 3>> shapes() {
  std::vector<std::array<int, 3>> result{{8, 8, 8}, {3, 5, 7}, {1, 6, 10}, {2, 16, 33}, {1, 1, 37}};
  for (const int z : {1, 2, 3}) {
    for (const int y : {1, 2, 3}) {
      for (const int x : {1, 2, 3}) {
        result.push_back({z, y, x});
      }
    }
  }
  return result;
}

/// A chunk, of which no two voxels that lie near each other are alike, in a buffer of just its
/// size.
struct Chunk {
  std::array<int, 3> shape;
  int bits;
  std::size_t size = static_cast<std::size_t>(shape[0] * shape[1] * shape[2] * 3 * bits / 8);
  std::unique_ptr<std::byte[]> voxels = std::make_unique<std::byte[]>(size);

  Chunk(const std::array<int, 3>& zyx, int bit_count) : shape(zyx), bits(bit_count) {
    for (std::size_t i = 0; i < size; ++i) {
      voxels[i] = static_cast<std::byte>((i * 7 + i / 251) % 223);
    }
  }

  const std::byte* voxel(int x, int y, int z) const {
    return voxels.get() + std::ptrdiff_t{((z * shape[1] + y) * shape[2] + x)} * 3 * bits / 8;
  }
};

/// Its brick, likewise: a byte too many read or written is found by AddressSanitizer.
std::vector<std::byte> brick_of(const Chunk& chunk, const TexelBlocks& blocks) {
  std::vector<std::byte> brick(blocks.brick_bytes(), kUntouched);
  brick.shrink_to_fit();
  blocks.lay_out({chunk.voxels.get(), chunk.size}, brick.data());
  return brick;
}

/// Blocks of texels of a chunk, one after the other.
std::vector<TexelBlocks::Box> boxes_of_blocks(const std::array<int, 3>& shape) {
  std::vector<TexelBlocks::Box> boxes;
  for (int z = 0; z < shape[0]; ++z) {
    for (int y = 0; y < shape[1]; y += TexelBlocks::kSide) {
      for (int x = 0; x < shape[2]; x += TexelBlocks::kSide) {
        boxes.push_back({{x, y, z},
                         {std::min(x + TexelBlocks::kSide, shape[2]),
                          std::min(y + TexelBlocks::kSide, shape[1]), z + 1}});
      }
    }
  }
  return boxes;
}

bool same_texel(const std::byte* a, const std::byte* b, const TexelBlocks& blocks) {
  return std::memcmp(a, b, static_cast<std::size_t>(blocks.texel_bytes())) == 0;
}

TEST(TexelBlocks, LaidOutOneByOneInAnyOrderAreTheBrick) {
  for (const int bits : {8, 16}) {
    for (const auto& shape : shapes()) {
      const TexelBlocks blocks(shape, bits);
      const Chunk chunk(shape, bits);
      std::vector<TexelBlocks::Box> boxes = boxes_of_blocks(shape);
      std::reverse(boxes.begin(), boxes.end());
      std::vector<std::byte> brick(blocks.brick_bytes(), kUntouched);
      std::size_t touched = 0;
      for (const TexelBlocks::Box& box : boxes) {
        const std::vector<std::byte> before = brick;
        blocks.lay_out({chunk.voxels.get(), chunk.size}, box, brick.data());
        const std::byte* const own = brick.data() + blocks.along_x(box.first[0]) +
                                     blocks.along_y(box.first[1]) + blocks.along_z(box.first[2]);
        for (std::size_t i = 0; i < brick.size(); ++i) {
          const std::ptrdiff_t place = brick.data() + i - own;
          const bool is_own = place >= 0 && place < blocks.block_bytes();
          ASSERT_TRUE(is_own || brick[i] == before[i]) << "wrote beyond the block";
          touched += brick[i] != before[i] ? 1 : 0;
        }
      }
      EXPECT_GT(touched, 0U);
      const std::vector<std::byte> whole = brick_of(chunk, blocks);
      for (int z = 0; z < shape[0]; ++z) {
        for (int y = 0; y < shape[1]; ++y) {
          for (int x = 0; x < shape[2]; ++x) {
            const int place = blocks.along_x(x) + blocks.along_y(y) + blocks.along_z(z);
            ASSERT_TRUE(same_texel(brick.data() + place, whole.data() + place, blocks));
          }
        }
      }
    }
  }
}

TEST(TexelBlocks, PutEachVoxelWhereItsCoordinatesSay) {
  for (const int bits : {8, 16}) {
    for (const auto& shape : shapes()) {
      const Chunk chunk(shape, bits);
      const TexelBlocks blocks(shape, bits);
      const std::vector<std::byte> brick = brick_of(chunk, blocks);
      for (int z = 0; z < shape[0]; ++z) {
        for (int y = 0; y < shape[1]; ++y) {
          for (int x = 0; x < shape[2]; ++x) {
            const int place = blocks.along_x(x) + blocks.along_y(y) + blocks.along_z(z);
            ASSERT_EQ(place, blocks.along(0, x) + blocks.along(1, y) + blocks.along(2, z));
            ASSERT_LE(static_cast<std::size_t>(place + blocks.texel_bytes()), brick.size());
            ASSERT_TRUE(same_texel(brick.data() + place, chunk.voxel(x, y, z), blocks))
                << bits << " bits, voxel " << x << " " << y << " " << z << " of " << shape[2] << " "
                << shape[1] << " " << shape[0];
          }
        }
      }
    }
  }
}

TEST(TexelBlocks, PutEachVoxelsNeighbourAlongXBehindIt) {
  for (const int bits : {8, 16}) {
    for (const auto& shape : shapes()) {
      const Chunk chunk(shape, bits);
      const TexelBlocks blocks(shape, bits);
      const std::vector<std::byte> brick = brick_of(chunk, blocks);
      for (int z = 0; z < shape[0]; ++z) {
        for (int y = 0; y < shape[1]; ++y) {
          for (int x = 0; x + 1 < shape[2]; ++x) {
            const int place = blocks.along_x(x) + blocks.along_y(y) + blocks.along_z(z);
            ASSERT_TRUE(same_texel(brick.data() + place + blocks.texel_bytes(),
                                   chunk.voxel(x + 1, y, z), blocks))
                << bits << " bits, voxel " << x << " " << y << " " << z << " of " << shape[2] << " "
                << shape[1] << " " << shape[0];
          }
        }
      }
    }
  }
}

TEST(TexelBlocks, AreALineOfTheProcessorsCacheEach) {
  EXPECT_EQ(TexelBlocks({8, 8, 8}, 8).block_bytes(), 64);
  EXPECT_EQ(TexelBlocks({8, 8, 8}, 16).block_bytes(), 128);
  const TexelBlocks blocks({8, 12, 20}, 8);
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 20; ++x) {
      const int pair = blocks.along_x(x) + blocks.along_y(y);
      EXPECT_EQ(pair / 64, (pair + 2 * blocks.texel_bytes() - 1) / 64);
      EXPECT_EQ(pair / 64, y / 4 * 5 + x / 4);
    }
  }
}

TEST(TexelBlocks, LeaveRoomForTheLoadOfAVectorAtTheLastPair) {
  for (const int bits : {8, 16}) {
    for (const auto& shape : shapes()) {
      const TexelBlocks blocks(shape, bits);
      const int last = blocks.along_x(shape[2] - 1) + blocks.along_y(shape[1] - 1) +
                       blocks.along_z(shape[0] - 1);
      EXPECT_LE(static_cast<std::size_t>(last + 16), blocks.brick_bytes() + TexelBlocks::slack());
    }
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
