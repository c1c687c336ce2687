#include "acquisition/job/time_left.hpp"

#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::seconds;

struct TimeLeftTest : testing::Test {
  TimeLeft left;
  TimePoint now{std::chrono::hours(1)};

  TimeLeftTest() { left.begin(now); }

  void layer_after(int time) {
    now += seconds(time);
    left.layer_done(now);
  }
};

TEST_F(TimeLeftTest, IsEstimatedFromTheFirstLayerOn) {
  EXPECT_FALSE(left.estimate(10));
  layer_after(60);
  EXPECT_DOUBLE_EQ(*left.estimate(10), 600.0);
  layer_after(30);
  EXPECT_DOUBLE_EQ(*left.estimate(10), 450.0);
}

TEST_F(TimeLeftTest, IsEstimatedAnewByTheNextRun) {
  layer_after(60);
  left.end();
  EXPECT_FALSE(left.estimate(10));
  left.begin(now += seconds(36000));
  EXPECT_FALSE(left.estimate(10));
  layer_after(90);
  EXPECT_DOUBLE_EQ(*left.estimate(10), 900.0);
}

TEST_F(TimeLeftTest, HasNoRangeBeforeItHasSeenAFewLayers) {
  for (int i = 0; i < 5; ++i) layer_after(60);  // four from the one before on
  EXPECT_FALSE(left.range(10));
  layer_after(60);
  EXPECT_TRUE(left.range(10));
}

TEST_F(TimeLeftTest, HasARangeByTheLayersOfEarlierRunsOnceThereIsAnEstimate) {
  for (int i = 0; i < 10; ++i) layer_after(60);
  left.end();
  left.begin(now += seconds(36000));
  EXPECT_FALSE(left.range(10));
  layer_after(60);
  EXPECT_DOUBLE_EQ(left.range(10)->high, 600.0);
}

TEST_F(TimeLeftTest, IsNarrowWhereEveryLayerTakesTheSame) {
  for (int i = 0; i < 10; ++i) layer_after(60);
  EXPECT_DOUBLE_EQ(left.range(10)->low, 600.0);
  EXPECT_DOUBLE_EQ(left.range(10)->high, 600.0);
}

TEST_F(TimeLeftTest, IsWideWhereTheyScatterAndWiderTheMoreAreLeft) {
  for (int i = 0; i < 10; ++i) layer_after(i % 2 == 0 ? 50 : 70);
  const auto few = left.range(1);
  const auto many = left.range(1000);
  EXPECT_LT(few->low, 50.0);
  EXPECT_GT(few->high, 70.0);
  EXPECT_LT(many->low, 57000.0);
  EXPECT_GT(many->high, 63000.0);
  EXPECT_GT(many->low, 50000.0);
  EXPECT_LT(many->high, 70000.0);
}

TEST_F(TimeLeftTest, HoldsTheEstimateThatCountsWaitsToo) {
  for (int i = 0; i < 10; ++i) layer_after(60);
  left.interrupted();
  layer_after(36000);
  layer_after(60);
  EXPECT_DOUBLE_EQ(left.range(10)->low, 600.0);
  EXPECT_DOUBLE_EQ(left.range(10)->high, *left.estimate(10));
  EXPECT_GT(*left.estimate(10), 10000.0);
}

}  // namespace
}  // namespace biotomy::tests
