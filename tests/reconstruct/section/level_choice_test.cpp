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

constexpr SectionBasis kAlongLayers{{1, 0, 0}, {0, 1, 0}};

LevelChoice choice(const BrickSource& source, double pixel,
                   Interpolation kind = Interpolation::linear,
                   const SectionBasis& axes = kAlongLayers) {
  return level_choice(source, {{{}, axes, 0.0, 0.0}, pixel, 1, 1}, kind);
}

LevelChoice linear(double pixel) {
  return choice(cubes(), pixel);
}

LevelChoice only(int level) {
  return {level, level, 0.0};
}

/// Rows along x, of a plane whose normal is turned from z towards y.
SectionBasis turned(double degrees) {
  const double angle = degrees * std::acos(-1.0) / 180.0;
  return {{1, 0, 0}, {0, std::cos(angle), std::sin(angle)}};
}

TEST(LevelChoice, APixelUpToAVoxelIsOfLevel0) {
  ASSERT_EQ(cubes().levels(), 4);
  for (const double pixel : {0.001, 5.0, 9.999, 10.0, 10.0 * (1 + 1e-9)}) {
    EXPECT_EQ(linear(pixel), only(0)) << pixel;
  }
}

TEST(LevelChoice, APixelOfALevelsVoxelIsOfThatLevelAlone) {
  for (const double part : {1.0, 1.0 - 1e-9, 1.0 + 1e-9}) {
    EXPECT_EQ(linear(20.0 * part), only(1)) << part;
    EXPECT_EQ(linear(40.0 * part), only(2)) << part;
    EXPECT_EQ(linear(80.0 * part), only(3)) << part;
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
  EXPECT_EQ(linear(39.9), only(2));
  EXPECT_EQ(linear(20.0 * std::exp2(0.876)), only(2));
  EXPECT_NEAR(linear(20.0 * std::exp2(0.874)).part, 0.874, 1e-12);
  EXPECT_NEAR(linear(20.0 * std::exp2(0.126)).part, 0.126, 1e-12);
  EXPECT_EQ(linear(20.0 * std::exp2(0.124)), only(1));
}

TEST(LevelChoice, EndsWithTheCoarsestLevel) {
  EXPECT_EQ(linear(81.0), only(3));
  EXPECT_EQ(linear(1e9), only(3));
}

TEST(LevelChoice, IsLevel0WhereThereIsNoOther) {
  MemorySource source;
  EXPECT_EQ(choice(source, 1000.0), only(0));
}

TEST(LevelChoice, OfCubicIsAsOfLinear) {
  EXPECT_EQ(choice(cubes(), 30.0, Interpolation::cubic), linear(30.0));
}

TEST(LevelChoice, OfNearestIsTheOneLevelThatIsNearer) {
  const auto nearest = [](double pixel) { return choice(cubes(), pixel, Interpolation::nearest); };
  EXPECT_EQ(nearest(14.1), only(0));
  EXPECT_EQ(nearest(14.2), only(1));
  EXPECT_EQ(nearest(56.5), only(2));
  EXPECT_EQ(nearest(56.6), only(3));
}

TEST(LevelChoice, OfCubesIsTheSameForAllPlanes) {
  for (const double pixel : {10.0, 13.0, 28.0, 40.0, 70.0}) {
    for (const double degrees : {0.0, 10.0, 45.0, 90.0}) {
      const LevelChoice turned_choice =
          choice(cubes(), pixel, Interpolation::linear, turned(degrees));
      EXPECT_EQ(turned_choice.levels(), linear(pixel).levels()) << pixel << ", " << degrees;
      EXPECT_NEAR(turned_choice.part, linear(pixel).part, 1e-9);
    }
  }
}

/// Layers thinner than their pixels are wide: level 1 has both of 20 µm, each of two layers.
MemorySource& thin_layers() {
  static MemorySource source;
  source.box = {{64, 64, 128}, {20.0, 20.0, 10.0}};
  source.pyramid = true;
  return source;
}

TEST(LevelChoice, MixesNoLayersForPixelsOfTheLayersOwn) {
  ASSERT_EQ(thin_layers().level(1).spacing, (Vector3{20.0, 20.0, 20.0}));
  EXPECT_EQ(choice(thin_layers(), 20.0), only(0));
  EXPECT_EQ(choice(thin_layers(), 20.0, Interpolation::nearest), only(0));
  EXPECT_EQ(choice(thin_layers(), 20.0, Interpolation::linear, turned(10.0)), only(0));
}

TEST(LevelChoice, PassesOverALevelThatIsCoarserAcrossThePlaneAlone) {
  const LevelChoice between = choice(thin_layers(), 20.0 * std::sqrt(2.0));
  EXPECT_EQ(between.levels(), (std::vector{0, 2}));
  EXPECT_NEAR(between.part, 0.5, 1e-12);
  EXPECT_EQ(choice(thin_layers(), 40.0), only(2));
}

TEST(LevelChoice, TakesThatLevelWhereThePlaneSeesIt) {
  const auto upright = [](double pixel) {
    return choice(thin_layers(), pixel, Interpolation::linear, turned(90.0));
  };
  EXPECT_EQ(upright(10.0), only(0));
  EXPECT_EQ(upright(10.0 * std::sqrt(2.0)).levels(), (std::vector{0, 1}));
  EXPECT_EQ(upright(20.0), only(1));
  EXPECT_EQ(upright(40.0), only(2));
  // Across a plane at 45° voxels lie 12.65 µm apart.
  EXPECT_EQ(choice(thin_layers(), 12.6, Interpolation::linear, turned(45.0)), only(0));
  EXPECT_NEAR(choice(thin_layers(), 16.0, Interpolation::linear, turned(45.0)).part,
              std::log(16.0 * std::sqrt(0.00625)) / std::log(20.0 * std::sqrt(0.00625)), 1e-12);
}

TEST(LevelChoice, GoesByTheFinestAxisOfAnisotropicVoxels) {
  MemorySource source;
  source.box = {{100, 100, 30}, {5.0, 6.0, 40.0}};
  source.pyramid = true;
  ASSERT_EQ(source.level(1).spacing, (Vector3{10.0, 12.0, 40.0}));
  EXPECT_EQ(choice(source, 5.0), only(0));
  EXPECT_EQ(choice(source, 10.0), only(1));
}

// A single photograph whose layer is thinner than its pixels are wide, for instance: that axis is
// never halved, so its spacing says nothing about how coarse a level is.
TEST(LevelChoice, DoesNotLookAtAnAxisOfOneVoxel) {
  MemorySource source;
  source.box = {{100, 100, 1}, {10.0, 10.0, 1.0}};
  source.pyramid = true;
  ASSERT_GT(source.levels(), 2);
  EXPECT_EQ(choice(source, 1.0), only(0));
  EXPECT_EQ(choice(source, 10.0), only(0));
  EXPECT_EQ(choice(source, 20.0), only(1));
}

TEST(LevelChoice, TakesAVolumeOfOneVoxel) {
  MemorySource source;
  source.box = {{1, 1, 1}, {10.0, 10.0, 10.0}};
  source.pyramid = true;
  EXPECT_EQ(choice(source, 1000.0), only(0));
}

TEST(LevelChoice, MayEndWithALevelOfOneVoxel) {
  MemorySource source;
  source.box = {{4, 4, 4}, {10.0, 10.0, 10.0}};
  source.chunk_size = {1, 1, 1};
  source.pyramid = true;
  ASSERT_EQ(source.levels(), 3);
  EXPECT_EQ(choice(source, 30.0).finer, 1);
  EXPECT_NEAR(choice(source, 30.0).part, std::log2(1.5), 1e-12);
  EXPECT_EQ(choice(source, 40.0), only(2));
}

}  // namespace
}  // namespace biotomy::reconstruct
