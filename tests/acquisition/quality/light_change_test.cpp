#include "acquisition/quality/light_change.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace biotomy::tests {
namespace {

using namespace acquisition;

struct Grids {
  cv::Mat before = cv::Mat(48, 64, CV_32FC3);
  cv::Mat now;
  cv::Mat casting = cv::Mat::zeros(48, 64, CV_8UC1);

  Grids() {
    cv::RNG(3).fill(before, cv::RNG::UNIFORM, 0.2, 0.6);
    now = before.clone();
  }
  /// Another content in a part of the frame.
  void change(const cv::Rect& part) { cv::RNG(4).fill(now(part), cv::RNG::UNIFORM, 0.1, 0.7); }
  MeasuredLight measured() const { return measure_light(now, before, casting); }
};

TEST(LightChange, IsNothingBetweenEqualFrames) {
  const MeasuredLight light = Grids().measured();
  EXPECT_NEAR(light.change.brightness().mean(), 0.0, 1e-9);
  EXPECT_NEAR(light.change.brightness().range(), 0.0, 1e-9);
  EXPECT_NEAR(light.change.cast(), 0.0, 1e-9);
}

TEST(LightChange, IsFoundBesideContentThatChanged) {
  Grids grids;
  grids.now = grids.before.mul(cv::Scalar(1.1, 1.0, 1.0));  // red alone
  grids.change({0, 0, 20, 48});
  const MeasuredLight light = grids.measured();
  EXPECT_NEAR(light.change.cast(), std::log(1.1), 0.003);
  EXPECT_NEAR(light.change.brightness().mean(), 0.25 * std::log(1.1), 0.003);
  EXPECT_EQ(light.steady.at<std::uint8_t>(24, 40), 255);
  EXPECT_LT(cv::countNonZero(light.steady(cv::Rect(0, 0, 20, 48))), 48);
}

TEST(LightChange, IsFoundFromLeftToRight) {
  Grids grids;
  for (int x = 0; x < 64; ++x) {
    const double factor = 1.0 + 0.2 * ((x + 0.5) / 64.0 - 0.5);
    grids.now.col(x) = grids.before.col(x) * factor;
  }
  grids.change({40, 10, 15, 25});
  const SmoothSurface brightness = grids.measured().change.brightness();
  EXPECT_NEAR(brightness.range(), 0.2, 0.01);
  EXPECT_NEAR(brightness.at(1.0, 0.0), std::log(1.1), 0.01);
}

TEST(LightChange, FollowsTheCastingMaterialWhereMostElseChanged) {
  Grids grids;
  grids.now = grids.before * 1.05;
  const cv::Rect inside(8, 6, 48, 36);
  grids.change(inside);
  grids.casting.setTo(255);
  grids.casting(inside).setTo(0);
  EXPECT_NEAR(grids.measured().change.brightness().mean(), std::log(1.05), 0.01);
}

TEST(LightChange, OfNoisierCellsIsLessSure) {
  Grids grids;
  const double sure = grids.measured().level_error;
  cv::Mat noise(grids.now.size(), CV_32FC3);
  cv::RNG(5).fill(noise, cv::RNG::NORMAL, 1.0, 0.1);
  grids.now = grids.now.mul(noise);
  EXPECT_GT(grids.measured().level_error, 3.0 * sure);
  EXPECT_GT(grids.measured().range_error, grids.measured().level_error);
}

TEST(LightChange, OfABlackFrameIsNotSureAtAll) {
  Grids grids;
  grids.now.setTo(0.0);
  EXPECT_DOUBLE_EQ(grids.measured().level_error, 1.0);
}

}  // namespace
}  // namespace biotomy::tests
