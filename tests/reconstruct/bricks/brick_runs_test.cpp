#include "reconstruct/bricks/brick_runs.hpp"

#include <algorithm>
#include <functional>
#include <random>
#include <vector>

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

  bool is_beyond_border(const RowAxis& axis) const {
    return voxel != inside || next != inside + axis.next;
  }
  BrickPair bricks(const RowAxis& axis) const { return {inside / axis.side, next / axis.side}; }
};

using Check = std::function<void(const RowPath&, int count, const std::vector<BrickRun>&)>;

void for_random_rows(const Check& check) {
  std::mt19937 random(1);
  RunFinder finder;
  for (int round = 0; round < 20; ++round) {
    for (int count = 1; count <= kMostPixels; ++count) {
      const RowPath path = tests::random_path(count, random);
      std::vector<BrickRun> runs;
      finder.find(path, count, runs);
      check(path, count, runs);
      if (testing::Test::HasFatalFailure()) {
        return;
      }
    }
  }
}

TEST(BrickRuns, FollowEachOtherFromTheFirstPixelToTheLast) {
  for_random_rows([](const RowPath&, int count, const std::vector<BrickRun>& runs) {
    int pixel = 0;
    for (const BrickRun& run : runs) {
      ASSERT_EQ(run.first, pixel);
      ASSERT_GT(run.last, run.first);
      pixel = run.last;
    }
    ASSERT_EQ(pixel, count);
  });
}

TEST(BrickRuns, HaveTheBricksOfEachOfTheirPixels) {
  int changes = 0;
  for_random_rows([&](const RowPath& path, int, const std::vector<BrickRun>& runs) {
    for (const BrickRun& run : runs) {
      for (int pixel = run.first; pixel < run.last; ++pixel) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          ASSERT_EQ(run.bricks[axis], Definition(path.axes[axis], pixel).bricks(path.axes[axis]));
        }
      }
    }
    changes += static_cast<int>(runs.size()) - 1;
  });
  EXPECT_GT(changes, 10'000);
}

TEST(BrickRuns, ArePartedOnlyWhereTexelsCannotBeReadInPairs) {
  int parted = 0;
  int whole = 0;
  for_random_rows([&](const RowPath& path, int, const std::vector<BrickRun>& runs) {
    for (const BrickRun& run : runs) {
      for (int pixel = run.first; pixel < run.last; ++pixel) {
        bool expected = run.bricks[0].near != run.bricks[0].far ||
                        (path.axes[2].step != 0 && run.bricks[2].near != run.bricks[2].far);
        for (const RowAxis& axis : path.axes) {
          expected = expected || Definition(axis, pixel).is_beyond_border(axis);
        }
        ASSERT_EQ(run.parted, expected);
        (expected ? parted : whole) += 1;
      }
    }
  });
  EXPECT_GT(parted, 10'000);
  EXPECT_GT(whole, 10'000);
}

TEST(BrickRuns, NameTheTexelsOfEachOfTheirPixels) {
  for_random_rows([](const RowPath& path, int, const std::vector<BrickRun>& runs) {
    for (const BrickRun& run : runs) {
      for (int pixel = run.first; pixel < run.last; ++pixel) {
        for (std::size_t i = 0; i < 3; ++i) {
          const RowAxis& axis = path.axes[i];
          const Definition is(axis, pixel);
          const TexelPair texels = texel_pair(axis, run.bricks[i], pixel);
          ASSERT_EQ(texels.near, is.inside % axis.side);
          ASSERT_EQ(texels.far, is.next % axis.side);
          ASSERT_TRUE(texels.part >= 0.0F && texels.part < 1.0F);
          if (is.voxel != is.inside || axis.next == 0) {
            ASSERT_EQ(texels.part, 0.0F);
          }
        }
      }
    }
  });
}

}  // namespace
}  // namespace biotomy::reconstruct
