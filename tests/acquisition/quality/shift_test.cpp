#include "acquisition/quality/shift.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/acquisition/quality/phantom_photographer.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

TEST(Shift, IsFoundBetweenFacesOfTwoLayers) {
  PhantomPhotographer camera({.width = 600, .height = 480, .left_um = 0.0, .top_um = 0.0});
  const BorderPatches before = take_border(camera.photograph(400.0));
  for (const cv::Point2d moved : {cv::Point2d(0.0, 0.0), {0.6, -1.3}, {-5.0, 2.0}, {14.0, 14.0}}) {
    // The view goes one way, what it shows the other.
    const auto shift =
        measure_shift(take_border(camera.photograph(420.0, -moved.x, -moved.y)), before);
    ASSERT_TRUE(shift) << moved;
    EXPECT_NEAR(shift->x, moved.x, 0.35);
    EXPECT_NEAR(shift->y, moved.y, 0.35);
  }
}

TEST(Shift, IsNotFoundWhereThereIsNothingButNoise) {
  const auto noise = [](std::uint64_t seed) {
    cv::Mat image(480, 600, CV_8UC3);
    cv::RNG(seed).fill(image, cv::RNG::NORMAL, 100.0, 3.0);
    return take_border(image);
  };
  EXPECT_FALSE(measure_shift(noise(1), noise(2)));
}

TEST(Shift, IsNotMeasuredInASmallFrame) {
  const BorderPatches border = take_border(cv::Mat(191, 400, CV_8UC3, cv::Scalar::all(90)));
  EXPECT_TRUE(border.patches.empty());
  EXPECT_FALSE(measure_shift(border, border));
}

}  // namespace
}  // namespace biotomy::tests
