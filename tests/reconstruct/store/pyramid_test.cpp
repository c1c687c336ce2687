#include "reconstruct/store/pyramid.hpp"

#include <gmock/gmock.h>

namespace biotomy::reconstruct {
namespace {

using testing::ElementsAre;

constexpr std::array<int, 3> kChunk{32, 32, 32};

TEST(Pyramid, HalvesAllAxesOfCubicVoxels) {
  EXPECT_THAT(pyramid_factors({{100, 100, 100}, {5, 5, 5}}, kChunk),
              ElementsAre(LevelFactor{1, 1, 1}, LevelFactor{2, 2, 2}, LevelFactor{4, 4, 4}));
}

TEST(Pyramid, HalvesTheFinestAxesUntilVoxelsAreAboutCubic) {
  EXPECT_THAT(pyramid_factors({{200, 200, 60}, {10, 10, 45}}, kChunk),
              ElementsAre(LevelFactor{1, 1, 1}, LevelFactor{2, 2, 1}, LevelFactor{4, 4, 1},
                          LevelFactor{8, 8, 2}));
}

TEST(Pyramid, HalvesOneAxisThatIsFinerThanTheOthers) {
  EXPECT_THAT(pyramid_factors({{40, 40, 64}, {20, 20, 5}}, kChunk),
              ElementsAre(LevelFactor{1, 1, 1}, LevelFactor{1, 1, 2}, LevelFactor{1, 1, 4},
                          LevelFactor{2, 2, 8}));
}

TEST(Pyramid, LeavesAnAxisOfOneVoxelAlone) {
  EXPECT_THAT(pyramid_factors({{100, 1, 1}, {10, 10, 1}}, kChunk),
              ElementsAre(LevelFactor{1, 1, 1}, LevelFactor{2, 1, 1}, LevelFactor{4, 1, 1}));
}

TEST(Pyramid, EndsAtOnceWhereOneChunkHoldsAll) {
  EXPECT_THAT(pyramid_factors({{32, 32, 32}, {10, 10, 20}}, kChunk), ElementsAre(LevelFactor{}));
}

TEST(Pyramid, ALevelsFirstVoxelLiesInTheMiddleOfThoseThatItAverages) {
  const PyramidLevel level = pyramid_level({{101, 64, 9}, {10, 12, 20}}, {4, 4, 2});
  EXPECT_EQ(level.size, (GridSize{26, 16, 5}));
  EXPECT_EQ(level.spacing, (Vector3{40, 48, 40}));
  EXPECT_EQ(level.origin, (Vector3{15, 18, 10}));
}

}  // namespace
}  // namespace biotomy::reconstruct
