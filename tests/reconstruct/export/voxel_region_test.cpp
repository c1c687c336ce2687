#include "reconstruct/export/voxel_region.hpp"

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"

namespace biotomy::reconstruct {
namespace {

const VoxelRegion kWhole{{0, 100}, {0, 80}, {0, 60}};

TEST(AVoxelRegion, IsReadFromItsText) {
  EXPECT_EQ(parse_region("1:20,0:80,5:6", kWhole), (VoxelRegion{{1, 20}, {0, 80}, {5, 6}}));
}

TEST(AVoxelRegion, ReachesToTheBorderWhereANumberIsLeftOut) {
  EXPECT_EQ(parse_region(":,10:,:7", kWhole), (VoxelRegion{{0, 100}, {10, 80}, {0, 7}}));
}

TEST(AVoxelRegion, IsRefusedWhenItMakesNoSense) {
  for (const char* text : {"", "1:2", "1:2,1:2", "1:2,1:2,1:2,1:2", "1:2,1:2,2", "2:1,1:2,1:2",
                           "1:1,1:2,1:2", "-1:2,1:2,1:2", "a:2,1:2,1:2", "1:2 ,1:2,1:2"}) {
    EXPECT_THROW(parse_region(text, kWhole), InvalidRequest) << text;
  }
}

TEST(AVoxelRegion, ThatLeadsOutOfTheVolumeNamesTheAxis) {
  EXPECT_THAT(message_of<SampleError>([] { parse_region("0:1,0:81,0:1", kWhole); }),
              testing::AllOf(testing::HasSubstr("along y"), testing::HasSubstr("80")));
}

TEST(AVoxelRegion, OfACoarserLevelHoldsEveryVoxelItHasAPartIn) {
  const Cuboid cuboid{{100, 80, 60}, {1, 1, 4}};
  EXPECT_EQ(region_of_level({{3, 9}, {4, 8}, {5, 6}}, pyramid_level(cuboid, {1, 1, 1}),
                            pyramid_level(cuboid, {4, 4, 1})),
            (VoxelRegion{{0, 3}, {1, 2}, {5, 6}}));
}

}  // namespace
}  // namespace biotomy::reconstruct
