#include "acquisition/calibration/fitness.hpp"

#include <cstdint>
#include <string>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "acquisition/calibration/calibration_record.hpp"
#include "acquisition/calibration/white_balance.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using bridge::Transfer;
using testing::HasSubstr;

/// Frames of a surface under light that falls off to a part of it at the right edge, with noise.
MeanFrame frames_of(const cv::Scalar& colour, double right = 0.8, double pattern = 0.0) {
  MeanFrame frames(Transfer::linear);
  for (std::uint64_t i = 0; i < 8; ++i) {
    cv::Mat frame(120, 160, CV_32FC3);
    cv::RNG(i + 1).fill(frame, cv::RNG::NORMAL, 0.0, 2.0);
    for (int x = 0; x < frame.cols; ++x) {
      const double light = 1.0 - (1.0 - right) * x / (frame.cols - 1);
      const double mark = (x / 2) % 2 == 0 ? 1.0 + pattern : 1.0 - pattern;
      frame.col(x) += colour * (light * mark);
    }
    cv::Mat image;
    frame.convertTo(image, CV_8U);
    frames.add(image);
  }
  return frames;
}

std::string said(const std::optional<std::string>& complaint) {
  return complaint.value_or("fit");
}

TEST(MeanOfFrames, KeepsPartsOfALevel) {
  MeanFrame frames(Transfer::linear);
  for (const int level : {10, 11, 11, 11}) {
    frames.add(cv::Mat(4, 4, CV_8UC3, cv::Scalar::all(level)));
  }
  EXPECT_EQ(frames.count(), 4);
  EXPECT_EQ(frames.bits(), 8);
  EXPECT_NEAR(frames.mean().at<cv::Vec3w>(1, 1)[0], 10.75 * 257.0, 0.5);
}

TEST(MeanOfFrames, OfSixteenBitsIsOnItsOwnScale) {
  MeanFrame frames(Transfer::linear);
  for (const int level : {60000, 65535}) {
    frames.add(cv::Mat(4, 4, CV_16UC3, cv::Scalar::all(level)));
  }
  EXPECT_EQ(frames.bits(), 16);
  EXPECT_NEAR(frames.mean().at<cv::Vec3w>(1, 1)[0], 62767.5, 0.6);
  EXPECT_EQ(frames.clipped(), 1.0);
}

TEST(MeanOfFrames, IsOfTheLightThatTheyShow) {
  MeanFrame eight(Transfer::srgb);
  for (const int level : {128, 188}) {
    eight.add(cv::Mat(4, 4, CV_8UC3, cv::Scalar(level, 0, 255)));
  }
  EXPECT_EQ(eight.bits(), 8);
  EXPECT_NEAR(eight.mean().at<cv::Vec3w>(1, 1)[0], 0.5 * (0.21586 + 0.50289) * 65535.0, 2.0);
  EXPECT_EQ(eight.mean().at<cv::Vec3w>(1, 1)[1], 0);
  EXPECT_EQ(eight.mean().at<cv::Vec3w>(1, 1)[2], 65535);
  EXPECT_NEAR(eight.clipped(), 1.0 / 3.0, 1e-9);
  MeanFrame sixteen(Transfer::srgb);
  sixteen.add(cv::Mat(4, 4, CV_16UC3, cv::Scalar::all(128 * 257)));
  EXPECT_NEAR(sixteen.mean().at<cv::Vec3w>(1, 1)[0], 0.21586 * 65535.0, 1.0);
}

TEST(MeanOfFrames, RefusesAFrameOfAnotherKind) {
  MeanFrame frames(Transfer::linear);
  frames.add(cv::Mat(4, 4, CV_8UC3, cv::Scalar::all(1)));
  EXPECT_THROW(frames.add(cv::Mat(4, 5, CV_8UC3)), CalibrationError);
  EXPECT_THROW(frames.add(cv::Mat(4, 4, CV_16UC3)), CalibrationError);
}

TEST(FlatField, IsOfABlankSurfaceUnderTolerablyEvenLight) {
  EXPECT_EQ(said(flat_complaint(frames_of({150, 140, 130}))), "fit");
  EXPECT_EQ(said(flat_complaint(frames_of({150, 140, 130}, 0.4))), "fit");
  EXPECT_THAT(said(flat_complaint(frames_of({150, 140, 130}, 0.05))), HasSubstr("below 0.25"));
  EXPECT_THAT(said(flat_complaint(frames_of({150, 140, 130}, 0.8, 0.05))),
              HasSubstr("has a pattern of 0.0"));
}

TEST(FlatField, IsNeitherDarkNorClipped) {
  EXPECT_THAT(said(flat_complaint(frames_of({150, 140, 5}))), HasSubstr("below 0.05"));
  EXPECT_THAT(said(flat_complaint(frames_of({245, 140, 130}, 1.0))), HasSubstr("above 0.9"));
  EXPECT_THAT(said(flat_complaint(frames_of({150, 256, 130}))), HasSubstr("are clipped"));
}

TEST(DarkField, IsDark) {
  EXPECT_EQ(said(dark_complaint(frames_of({5, 5, 5}))), "fit");
  EXPECT_THAT(said(dark_complaint(frames_of({5, 40, 5}))), HasSubstr("above 0.1"));
}

TEST(BalanceOfWhite, MakesTheCardNeutral) {
  const MeanFrame frames = frames_of({100, 150, 75}, 1.0);
  EXPECT_EQ(said(white_complaint(frames)), "fit");
  const WhiteBalance balance = white_balance(frames, {1.2, 2.0});
  EXPECT_NEAR(balance.red_gain, 1.2 * 1.5, 0.01);
  EXPECT_NEAR(balance.blue_gain, 2.0 * 2.0, 0.01);
  EXPECT_THAT(said(white_complaint(frames_of({150, 256, 130}))), HasSubstr("are clipped"));
}

// Red has half of green's light and blue a quarter: sRGB's levels for 0.25, 0.5 and 0.125.
TEST(BalanceOfWhite, IsOfTheLightAndNotOfItsCoding) {
  MeanFrame frames(Transfer::srgb);
  frames.add(cv::Mat(40, 40, CV_8UC3, cv::Scalar(137, 188, 99)));
  const WhiteBalance balance = white_balance(frames, {1.5, 1.0});
  EXPECT_NEAR(balance.red_gain, 1.5 * 2.0, 0.05);
  EXPECT_NEAR(balance.blue_gain, 4.0, 0.1);
}

TEST(DarkField, MayHaveTheBlackLevelThatACameraDoesNotTell) {
  MeanFrame frames(Transfer::srgb);
  frames.add(cv::Mat(40, 40, CV_16UC3, cv::Scalar::all(18126)));  // 1/16 of the light
  EXPECT_EQ(said(dark_complaint(frames)), "fit");
}

}  // namespace
}  // namespace biotomy::tests
