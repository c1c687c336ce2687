#include "reconstruct/section/level_choice.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/reconstruct/bricks/memory_source.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::MemorySource;

/// Voxels of 10, 20, 40 … micrometres; the coarsest of 80.
MemorySource& cubes() {
  static MemorySource source;
  source.box = {{60, 60, 60}, {10.0, 10.0, 10.0}};
  source.pyramid = true;
  return source;
}

LevelChoice linear(double pixel) {
  return level_choice(cubes(), pixel, Interpolation::linear);
}

TEST(LevelChoice, APixelUpToAVoxelIsOfLevel0) {
  ASSERT_EQ(cubes().levels(), 4);
  for (const double pixel : {0.001, 5.0, 9.999, 10.0, 10.0 * (1 + 1e-9)}) {
    EXPECT_EQ(linear(pixel), (LevelChoice{0, 0.0})) << pixel;
  }
}

TEST(LevelChoice, APixelOfALevelsVoxelIsOfThatLevelAlone) {
  for (const double part : {1.0, 1.0 - 1e-9, 1.0 + 1e-9}) {
    EXPECT_EQ(linear(20.0 * part), (LevelChoice{1, 0.0})) << part;
    EXPECT_EQ(linear(40.0 * part), (LevelChoice{2, 0.0})) << part;
    EXPECT_EQ(linear(80.0 * part), (LevelChoice{3, 0.0})) << part;
  }
}

TEST(LevelChoice, BetweenTwoLevelsGoesWithTheLogarithm) {
  EXPECT_EQ(linear(20.0 * std::sqrt(2.0)).finer, 1);
  EXPECT_NEAR(linear(20.0 * std::sqrt(2.0)).part, 0.5, 1e-12);
  EXPECT_EQ(linear(13.0).finer, 0);
  EXPECT_NEAR(linear(13.0).part, std::log2(1.3), 1e-12);
  EXPECT_NEAR(linear(36.5).part, std::log2(1.825), 1e-12);
}

TEST(LevelChoice, LeavesALevelOutWhosePartIsBelowAnEighth) {
  EXPECT_EQ(linear(39.9), (LevelChoice{2, 0.0}));
  EXPECT_EQ(linear(20.0 * std::exp2(0.876)), (LevelChoice{2, 0.0}));
  EXPECT_NEAR(linear(20.0 * std::exp2(0.874)).part, 0.874, 1e-12);
  EXPECT_NEAR(linear(20.0 * std::exp2(0.126)).part, 0.126, 1e-12);
  EXPECT_EQ(linear(20.0 * std::exp2(0.124)), (LevelChoice{1, 0.0}));
}

TEST(LevelChoice, EndsWithTheCoarsestLevel) {
  EXPECT_EQ(linear(81.0), (LevelChoice{3, 0.0}));
  EXPECT_EQ(linear(1e9), (LevelChoice{3, 0.0}));
}

TEST(LevelChoice, IsLevel0WhereThereIsNoOther) {
  MemorySource source;
  EXPECT_EQ(level_choice(source, 1000.0, Interpolation::linear), (LevelChoice{0, 0.0}));
}

TEST(LevelChoice, OfCubicIsAsOfLinear) {
  EXPECT_EQ(level_choice(cubes(), 30.0, Interpolation::cubic), linear(30.0));
}

TEST(LevelChoice, OfNearestIsTheOneLevelThatIsNearer) {
  const auto nearest = [](double pixel) {
    return level_choice(cubes(), pixel, Interpolation::nearest);
  };
  EXPECT_EQ(nearest(14.1), (LevelChoice{0, 0.0}));
  EXPECT_EQ(nearest(14.2), (LevelChoice{1, 0.0}));
  EXPECT_EQ(nearest(56.5), (LevelChoice{2, 0.0}));
  EXPECT_EQ(nearest(56.6), (LevelChoice{3, 0.0}));
}

TEST(LevelChoice, GoesByTheFinestAxisOfAnisotropicVoxels) {
  MemorySource source;
  source.box = {{100, 100, 30}, {5.0, 6.0, 40.0}};
  source.pyramid = true;
  ASSERT_EQ(source.level(1).spacing, (Vector3{10.0, 12.0, 40.0}));
  EXPECT_EQ(level_choice(source, 5.0, Interpolation::linear), (LevelChoice{0, 0.0}));
  EXPECT_EQ(level_choice(source, 10.0, Interpolation::linear), (LevelChoice{1, 0.0}));
}

// A single photograph whose layer is thinner than its pixels are wide, for instance: that axis is
// never halved, so its spacing says nothing about how coarse a level is.
TEST(LevelChoice, DoesNotLookAtAnAxisOfOneVoxel) {
  MemorySource source;
  source.box = {{100, 100, 1}, {10.0, 10.0, 1.0}};
  source.pyramid = true;
  ASSERT_GT(source.levels(), 2);
  EXPECT_EQ(level_choice(source, 1.0, Interpolation::linear), (LevelChoice{0, 0.0}));
  EXPECT_EQ(level_choice(source, 10.0, Interpolation::linear), (LevelChoice{0, 0.0}));
  EXPECT_EQ(level_choice(source, 20.0, Interpolation::linear), (LevelChoice{1, 0.0}));
}

TEST(LevelChoice, TakesAVolumeOfOneVoxel) {
  MemorySource source;
  source.box = {{1, 1, 1}, {10.0, 10.0, 10.0}};
  source.pyramid = true;
  EXPECT_EQ(level_choice(source, 1000.0, Interpolation::linear), (LevelChoice{0, 0.0}));
}

TEST(LevelChoice, MayEndWithALevelOfOneVoxel) {
  MemorySource source;
  source.box = {{4, 4, 4}, {10.0, 10.0, 10.0}};
  source.chunk_size = {1, 1, 1};
  source.pyramid = true;
  ASSERT_EQ(source.levels(), 3);
  EXPECT_EQ(level_choice(source, 30.0, Interpolation::linear).finer, 1);
  EXPECT_NEAR(level_choice(source, 30.0, Interpolation::linear).part, std::log2(1.5), 1e-12);
  EXPECT_EQ(level_choice(source, 40.0, Interpolation::linear), (LevelChoice{2, 0.0}));
}

}  // namespace
}  // namespace biotomy::reconstruct
