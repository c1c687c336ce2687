#include "reconstruct/section/chunk_window.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/section/memory_source.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::MemorySource;

/// Gives chunks that are too short.
struct ShortSource final : ChunkSource {
  Cuboid box{{8, 8, 8}, {1.0, 1.0, 1.0}};
  const Cuboid& cuboid() const override { return box; }
  std::array<int, 3> chunk_shape() const override { return {8, 8, 8}; }
  int bits() const override { return 8; }
  std::shared_ptr<const ChunkVoxels> chunk(ChunkIndex) override {
    return std::make_shared<ChunkVoxels>(5);
  }
};

TEST(ChunkWindow, FetchesAChunkOnceAndOnlyWhenItIsAskedFor) {
  MemorySource source;
  ChunkWindow window(source, {{0, 0, 0}, {39, 29, 19}});
  EXPECT_TRUE(source.asked.empty());
  const std::byte* voxels = window.chunk({2, 1, 0});
  EXPECT_EQ(window.chunk({2, 1, 0}), voxels);
  EXPECT_EQ(source.asked.size(), 1U);
  EXPECT_EQ(window.touched(), (std::vector<ChunkIndex>{{0, 1, 2}}));
}

TEST(ChunkWindow, FindsEachChunkOfItsBox) {
  MemorySource source;
  source.level = [](int x, int y, int z, int) { return x / 8 + 10 * (y / 8) + 100 * (z / 8); };
  ChunkWindow window(source, {{9, 0, 8}, {30, 29, 19}});
  for (int z = 1; z <= 2; ++z) {
    for (int y = 0; y <= 3; ++y) {
      for (int x = 1; x <= 3; ++x) {
        EXPECT_EQ(static_cast<int>(*window.chunk({x, y, z})), (x + 10 * y + 100 * z) & 255);
      }
    }
  }
}

TEST(ChunkWindow, GivesZerosForAChunkThatWasNeverWritten) {
  MemorySource source;
  source.never_written = {{0, 0, 0}};
  ChunkWindow window(source, {{0, 0, 0}, {7, 7, 7}});
  const std::byte* voxels = window.chunk({0, 0, 0});
  EXPECT_TRUE(std::all_of(voxels, voxels + 8 * 8 * 8 * 3,
                          [](std::byte level) { return level == std::byte{0}; }));
}

TEST(ChunkWindow, RefusesAChunkOfTheWrongSize) {
  ShortSource source;
  ChunkWindow window(source, {{0, 0, 0}, {7, 7, 7}});
  EXPECT_THROW(window.chunk({0, 0, 0}), SampleError);
}

}  // namespace
}  // namespace biotomy::reconstruct
