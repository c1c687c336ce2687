#include "reconstruct/bricks/row_path.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "tests/reconstruct/bricks/random_path.hpp"

namespace biotomy::reconstruct {
namespace {

/// A pixel along one axis, by the definition of linear interpolation.
struct Definition {
  int voxel;   // where it lies
  int inside;  // the nearest to it in the volume
  int next;    // what that is mixed with

  Definition(const RowAxis& axis, int pixel)
      : voxel(axis.base + ((axis.start + pixel * axis.step) >> kFractionBits)),
        inside(std::clamp(voxel, axis.first, axis.last)),
        next(voxel == inside ? std::min(inside + axis.next, axis.last) : inside) {}
};

void for_random_rows(const std::function<void(const RowPath&, int count)>& check) {
  std::mt19937 random(1);
  for (int round = 0; round < 20; ++round) {
    for (int count = 1; count <= kMostPixels; ++count) {
      check(tests::random_path(count, random), count);
      if (testing::Test::HasFatalFailure()) {
        return;
      }
    }
  }
}

TEST(RowPath, HasPixelsInTheBricksAndTexelsOfTheirVoxels) {
  int parted = 0;
  for_random_rows([&](const RowPath& path, int count) {
    for (const RowAxis& axis : path.axes) {
      for (int pixel = 0; pixel < count; ++pixel) {
        const Definition is(axis, pixel);
        const AxisPlace place(axis, pixel);
        ASSERT_EQ(place.near_brick, is.inside / axis.side);
        ASSERT_EQ(place.far_brick, is.next / axis.side);
        ASSERT_EQ(place.near, is.inside % axis.side);
        ASSERT_EQ(place.far, is.next % axis.side);
        parted += place.near_brick != place.far_brick ? 1 : 0;
      }
    }
  });
  EXPECT_GT(parted, 10'000);
}

TEST(RowPath, MixesNothingBeyondTheBorderNorOnCentres) {
  int alone = 0;
  for_random_rows([&](const RowPath& path, int count) {
    for (const RowAxis& axis : path.axes) {
      for (int pixel = 0; pixel < count; ++pixel) {
        const Definition is(axis, pixel);
        const AxisPlace place(axis, pixel);
        ASSERT_TRUE(place.part >= 0.0F && place.part < 1.0F);
        if (is.voxel != is.inside || is.voxel == axis.last || axis.next == 0) {
          ASSERT_EQ(place.part, 0.0F);
          ++alone;
        }
      }
    }
  });
  EXPECT_GT(alone, 10'000);
}

TEST(RowPath, IsInsideWhereAllItsPixelsAreWithTheirNextVoxels) {
  int inside = 0;
  int outside = 0;
  for_random_rows([&](const RowPath& path, int count) {
    for (const RowAxis& axis : path.axes) {
      bool expected = true;
      for (int pixel = 0; pixel < count; ++pixel) {
        const Definition is(axis, pixel);
        expected = expected && is.voxel == is.inside && is.voxel + axis.next <= axis.last;
      }
      ASSERT_EQ(axis.is_inside(count), expected);
      (expected ? inside : outside) += 1;
    }
  });
  EXPECT_GT(inside, 1000);
  EXPECT_GT(outside, 1000);
}

TEST(SupportBricksTest, AreOneNumberAndBack) {
  for (const std::int32_t slot : {0, 1, 4095, 1 << 27}) {
    for (unsigned further = 0; further < 8; ++further) {
      const SupportBricks back = SupportBricks::of(SupportBricks{slot, further}.number());
      EXPECT_EQ(back.slot, slot);
      EXPECT_EQ(back.further, further);
    }
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
