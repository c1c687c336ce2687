#include "tests/quality/roc.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

TEST(Roc, HasAnAreaOfOneWhenAMetricTellsAllFrames) {
  EXPECT_EQ(area_under_roc({{1, 2, 3}, {4, 5}, false}), 1.0);
  EXPECT_EQ(area_under_roc({{4, 5}, {1, 2, 3}, true}), 1.0);
  EXPECT_EQ(area_under_roc({{4, 5}, {1, 2, 3}, false}), 0.0);
}

TEST(Roc, CountsTiesByHalfAndWrongPairsNotAtAll) {
  EXPECT_EQ(area_under_roc({{2, 2}, {2, 2}, false}), 0.5);
  EXPECT_EQ(area_under_roc({{1, 3}, {2, 3}, false}), (1 + 0 + 1 + 0.5) / 4);
}

TEST(Roc, DetectsByTheLimitThatRejectsNoMoreGoodFramesThanAllowed) {
  MetricValues values;
  for (int i = 0; i < 100; ++i) values.good.push_back(i);
  values.bad = {98.5, 99.5, 50, 200};
  EXPECT_EQ(detection_at(values, 0.0), 0.5);
  EXPECT_EQ(detection_at(values, 0.01), 0.75);
  EXPECT_EQ(detection_at(values, 0.5), 1.0);
  for (double& value : values.good) value = -value;
  for (double& value : values.bad) value = -value;
  values.low_is_bad = true;
  EXPECT_EQ(detection_at(values, 0.01), 0.75);
}

TEST(Roc, IsNoNumberWithoutFramesOfBothKinds) {
  EXPECT_TRUE(std::isnan(area_under_roc({{1}, {}, false})));
  EXPECT_TRUE(std::isnan(detection_at({{}, {1}, false}, 0.5)));
}

}  // namespace
}  // namespace biotomy::tests
