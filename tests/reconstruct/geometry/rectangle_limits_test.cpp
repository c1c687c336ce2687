#include "reconstruct/geometry/rectangle_limits.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

using Limits = std::vector<RectangleLimit>;

TEST(LargestShape, OfOneLimitGivesEachSideHalfOfIt) {
  const RectangleShape shape = largest_shape(Limits{{2.0, 3.0, 12.0}});
  EXPECT_DOUBLE_EQ(shape.width, 3.0);
  EXPECT_DOUBLE_EQ(shape.height, 2.0);
}

TEST(LargestShape, LiesInTheCornerOfTwoLimits) {
  const RectangleShape shape = largest_shape(Limits{{1.0, 0.0, 5.0}, {0.0, 2.0, 6.0}});
  EXPECT_DOUBLE_EQ(shape.width, 5.0);
  EXPECT_DOUBLE_EQ(shape.height, 3.0);
}

TEST(LargestShape, HasNoAreaWhereALimitAllowsNone) {
  EXPECT_EQ(largest_shape(Limits{{1.0, 1.0, 0.0}, {1.0, 2.0, 3.0}}).area(), 0.0);
  EXPECT_EQ(largest_shape(Limits{{1.0, 1.0, -1.0}}).area(), 0.0);
}

TEST(LargestShape, HasNoAreaWhereASideHasNoBound) {
  EXPECT_EQ(largest_shape(Limits{}).area(), 0.0);
  EXPECT_EQ(largest_shape(Limits{{1.0, 0.0, 5.0}}).area(), 0.0);
}

TEST(LargestShape, IsNoSmallerThanAnyWidthWithTheHeightThatIsLeft) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> part(0.01, 1.0);
  for (int i = 0; i < 500; ++i) {
    Limits limits;
    for (unsigned count = 1 + random() % 8; count > 0; --count) {
      limits.push_back({part(random), part(random), part(random)});
    }
    double best = 0.0;
    double widest = 100.0;
    for (const RectangleLimit& limit : limits) {
      widest = std::min(widest, limit.c / limit.a);
    }
    constexpr int kSteps = 2000;
    for (int step = 1; step < kSteps; ++step) {
      const double width = widest * step / kSteps;
      double height = 1e9;
      for (const RectangleLimit& limit : limits) {
        height = std::min(height, (limit.c - limit.a * width) / limit.b);
      }
      best = std::max(best, width * height);
    }
    const RectangleShape shape = largest_shape(limits);
    EXPECT_GE(shape.area(), best * (1.0 - 1e-14));
    EXPECT_LE(shape.area(), best * (1.0 + 2e-3));
    for (const RectangleLimit& limit : limits) {
      EXPECT_LE(limit.a * shape.width + limit.b * shape.height, limit.c * (1.0 + 1e-15));
    }
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
