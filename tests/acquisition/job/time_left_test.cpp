#include "acquisition/job/time_left.hpp"

#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::seconds;

struct TimeLeftTest : testing::Test {
  TimeLeft left;
  TimePoint now{std::chrono::hours(1)};

  void layer_after(int time) {
    now += seconds(time);
    left.layer_done(now);
  }
};

TEST_F(TimeLeftTest, SaysNothingBeforeItHasSeenAFewLayers) {
  for (int i = 0; i < 5; ++i) layer_after(60);  // four whole ones
  EXPECT_FALSE(left.of(10, 600.0));
  layer_after(60);
  EXPECT_TRUE(left.of(10, 600.0));
  EXPECT_FALSE(left.of(10, std::nullopt));
}

TEST_F(TimeLeftTest, IsNarrowWhereEveryLayerTakesTheSame) {
  for (int i = 0; i < 10; ++i) layer_after(60);
  EXPECT_DOUBLE_EQ(left.of(10, 600.0)->low, 600.0);
  EXPECT_DOUBLE_EQ(left.of(10, 600.0)->high, 600.0);
}

TEST_F(TimeLeftTest, IsWideWhereTheyScatterAndWiderTheMoreAreLeft) {
  for (int i = 0; i < 10; ++i) layer_after(i % 2 == 0 ? 50 : 70);
  const auto few = left.of(1, 60.0);
  const auto many = left.of(1000, 60000.0);
  EXPECT_LT(few->low, 50.0);
  EXPECT_GT(few->high, 70.0);
  EXPECT_LT(many->low, 57000.0);
  EXPECT_GT(many->high, 63000.0);
  EXPECT_GT(many->low, 50000.0);
  EXPECT_LT(many->high, 70000.0);
}

TEST_F(TimeLeftTest, HoldsTheEstimate) {
  for (int i = 0; i < 10; ++i) layer_after(60);
  EXPECT_DOUBLE_EQ(left.of(10, 900.0)->high, 900.0);
  EXPECT_DOUBLE_EQ(left.of(10, 500.0)->low, 500.0);
}

TEST_F(TimeLeftTest, DoesNotTakeAPauseForALayer) {
  for (int i = 0; i < 10; ++i) layer_after(60);
  left.interrupted();
  layer_after(36000);
  layer_after(60);
  EXPECT_DOUBLE_EQ(left.of(10, 600.0)->high, 600.0);
}

}  // namespace
}  // namespace biotomy::tests
