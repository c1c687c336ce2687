#include "acquisition/focus/depth_of_field.hpp"

#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

TEST(DepthOfField, AddsDiffractionAndPixel) {
  EXPECT_NEAR(depth_of_field({0.1, {0.55}, {10.0}}).value, 55.0 + 100.0, 1e-9);
  EXPECT_NEAR(depth_of_field({0.25, {0.5}, {2.0}}).value, 8.0 + 8.0, 1e-9);
}

TEST(DepthOfField, ByACurveIsAsLongAsItsBracketIsWideToEitherSide) {
  EXPECT_NEAR(depth_of_field_by_curve({20.0}, 5).value, 40.0, 1e-9);
  EXPECT_NEAR(depth_of_field_by_curve({20.0}, 9).value, 80.0, 1e-9);
}

}  // namespace
}  // namespace biotomy::acquisition
