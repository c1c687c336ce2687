#include "acquisition/quality/surface_colours.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace biotomy::tests {
namespace {

using namespace acquisition;

/// Cells of one colour, 24 × 24 regions of 6 cells.
cv::Mat cells() {
  return {144, 144, CV_8UC3, cv::Scalar(100, 100, 100)};
}

int unknown(const std::vector<cv::Mat>& faces, const cv::Mat& now) {
  std::vector<std::shared_ptr<const SurfaceColours>> colours;
  for (const cv::Mat& face : faces) colours.push_back(std::make_shared<const SurfaceColours>(face));
  return cv::countNonZero(KnownColours(colours).unknown_in(now));
}

TEST(SurfaceColours, KnowWhatARecentFaceHad) {
  cv::Mat with_red = cells();
  with_red(cv::Rect(60, 60, 2, 2)).setTo(cv::Scalar(200, 40, 40));
  EXPECT_EQ(unknown({cells()}, cells()), 0);
  EXPECT_EQ(unknown({cells()}, with_red), 4);
  EXPECT_EQ(unknown({with_red, cells()}, with_red), 0);
}

TEST(SurfaceColours, AreKnownInTheRegionBesideAndNoFurther) {
  cv::Mat before = cells();
  before.at<cv::Vec3b>(63, 63) = {200, 40, 40};
  for (const auto& [x, expected] : {std::pair{66, 0}, {71, 0}, {72, 1}, {59, 0}, {53, 1}}) {
    cv::Mat now = cells();
    now.at<cv::Vec3b>(63, x) = {200, 40, 40};
    EXPECT_EQ(unknown({before}, now), expected) << x;
  }
}

TEST(SurfaceColours, ExtendByOneStepOfEachColour) {
  for (int colour = 0; colour < 3; ++colour) {
    for (const auto& [value, expected] : {std::pair{108, 0}, {92, 0}, {114, 1}, {87, 1}}) {
      cv::Mat now = cells();
      now.at<cv::Vec3b>(10, 10)[colour] = static_cast<std::uint8_t>(value);
      EXPECT_EQ(unknown({cells()}, now), expected) << colour << ": " << value;
    }
  }
}

}  // namespace
}  // namespace biotomy::tests
