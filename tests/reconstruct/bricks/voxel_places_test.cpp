#include "reconstruct/bricks/voxel_places.hpp"

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

const TexelBlocks kBlocks({3, 5, 7}, 8);
constexpr std::array<int, 3> kSides{7, 5, 3};  // x, y, z

TEST(VoxelPlaces, AreTheBrickAndTheTexelOfEachVoxel) {
  constexpr int kStride = 10;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int side = kSides[axis];
    const VoxelPlaces places(kBlocks, axis, 9, 30, 100, side, 9 / side, kStride);
    for (int voxel = 9; voxel <= 30; ++voxel) {
      const VoxelPlaces::Place& place = places.of(voxel);
      EXPECT_EQ(place.slot, (voxel / side - 9 / side) * kStride);
      EXPECT_EQ(place.texel, voxel % side);
      EXPECT_EQ(place.offset, kBlocks.along(axis, voxel % side));
    }
  }
}

TEST(VoxelPlaces, BeyondTheBorderAreThoseOfTheBorder) {
  const VoxelPlaces places(kBlocks, 1, -2, 12, 11, 5, 0, 1);
  for (const int voxel : {-2, -1}) {
    EXPECT_EQ(places.of(voxel).slot, 0);
    EXPECT_EQ(places.of(voxel).texel, 0);
  }
  for (const int voxel : {11, 12}) {
    EXPECT_EQ(places.of(voxel).slot, 2);
    EXPECT_EQ(places.of(voxel).texel, 0);
    EXPECT_EQ(places.of(voxel).offset, 0);
  }
}

TEST(VoxelPlaces, OfAnAxisOfOneVoxelAreAllOne) {
  const VoxelPlaces places(kBlocks, 2, -4, 4, 1, 3, 0, 6);
  for (int voxel = -4; voxel <= 4; ++voxel) {
    EXPECT_EQ(places.of(voxel).slot, 0);
    EXPECT_EQ(places.of(voxel).texel, 0);
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
