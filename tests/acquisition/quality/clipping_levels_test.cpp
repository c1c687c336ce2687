#include "acquisition/quality/clipping_levels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "acquisition/calibration/field_correction.hpp"
#include "acquisition/quality/assessment.hpp"
#include "acquisition/quality/frame_measures.hpp"
#include "reconstruct/picture/jpeg_reader.hpp"
#include "reconstruct/picture/jpeg_writer.hpp"

namespace biotomy::tests {
namespace {

using acquisition::clipping_levels;
using acquisition::ClippingLevels;

constexpr int kWidth = 320;
constexpr int kHeight = 240;

/// Light of texture with a sensor's noise, of what saturates it, CV_32FC3. Tissue in the middle,
/// casting material of `brightness` around it.
cv::Mat light(double brightness, double noise = 0.006) {
  cv::Mat scene(kHeight, kWidth, CV_32FC3, cv::Scalar(1.0, 0.97, 0.94) * brightness);
  cv::Mat texture(kHeight / 2, kWidth / 2, CV_32FC3);
  cv::RNG(1).fill(texture, cv::RNG::NORMAL, 0.5 * brightness, 0.15 * brightness);
  cv::GaussianBlur(texture, texture, {}, 1.5);
  texture.copyTo(scene(cv::Rect(kWidth / 4, kHeight / 4, kWidth / 2, kHeight / 2)));
  cv::Mat grain(scene.size(), CV_32FC3);
  cv::RNG(2).fill(grain, cv::RNG::NORMAL, 0.0, noise);
  return scene + grain;
}

/// As a converter of so many bits gives it.
cv::Mat converted(const cv::Mat& light, int bits, int shift = 0) {
  const double full = (1 << bits) - 1;
  cv::Mat values;
  light.convertTo(values, CV_32S, full);
  values = cv::max(cv::min(values, full), 0.0);
  cv::Mat stored;
  values.convertTo(stored, bits == 8 ? CV_8U : CV_16U, 1 << shift);
  return stored;
}

cv::Mat through_jpeg(const cv::Mat& image, int quality) {
  return reconstruct::decode_jpeg(reconstruct::encode_jpeg(image, {}, quality));
}

/// Of the pixels.
double clipped(const cv::Mat& image) {
  const acquisition::FrameMeasures measures = acquisition::measure_frame(image);
  double pixels = 0.0;
  for (int i = 0; i < measures.grid.count(); ++i) {
    pixels += measures.tiles[static_cast<std::size_t>(i)].clipped * measures.grid.tile(i).area();
  }
  return pixels / static_cast<double>(image.total());
}

/// Of what the sensor saw.
double saturated(const cv::Mat& light) {
  cv::Mat most;
  cv::reduce(light.reshape(1, kWidth * kHeight), most, 1, cv::REDUCE_MAX);
  return cv::countNonZero(most >= 1.0F) / static_cast<double>(light.total());
}

/// Whether the daemon would say so.
bool is_found_clipped(const cv::Mat& image) {
  bridge::Frame frame;
  frame.image = image;
  acquisition::FrameExpectation expectation;
  expectation.width = image.cols;
  expectation.height = image.rows;
  expectation.type = image.type();
  expectation.layer = 1;
  const auto metrics = acquisition::assess(frame, expectation, {}).metrics;
  return std::ranges::any_of(metrics, [](const acquisition::Metric& metric) {
    return metric.name == "clipped_fraction" && !metric.passed;
  });
}

TEST(ClippingLevels, AreAtFullScaleInAFrameThatReachesIt) {
  const cv::Mat scene = light(1.3);
  EXPECT_EQ(clipping_levels(converted(scene, 16)), (ClippingLevels{65535, 65535, 65535}));
  EXPECT_NEAR(clipped(converted(scene, 16)), saturated(scene), 0.002);
  EXPECT_NEAR(clipped(converted(scene, 8)), saturated(scene), 0.01);
  EXPECT_TRUE(is_found_clipped(converted(scene, 8)));
}

TEST(ClippingLevels, AreWhereAConvertersValuesEndInSixteenBits) {
  const cv::Mat scene = light(1.3);
  for (const int bits : {10, 12, 14}) {
    const int full = (1 << bits) - 1;
    EXPECT_EQ(clipping_levels(converted(scene, bits)), (ClippingLevels{full, full, full}));
    EXPECT_NEAR(clipped(converted(scene, bits)), saturated(scene), 0.01) << bits;
    EXPECT_TRUE(is_found_clipped(converted(scene, bits))) << bits;
    const int shift = 16 - bits;
    EXPECT_EQ(clipping_levels(converted(scene, bits, shift))[1], full << shift);
    EXPECT_NEAR(clipped(converted(scene, bits, shift)), saturated(scene), 0.01) << bits;
    EXPECT_TRUE(is_found_clipped(converted(scene, bits, shift))) << bits;
  }
}

TEST(ClippingLevels, AreWhereABlackLevelWasTakenOff) {
  const cv::Mat frame = converted(light(1.3), 12) - cv::Scalar::all(64.0);
  EXPECT_EQ(clipping_levels(frame), (ClippingLevels{4031, 4031, 4031}));
}

TEST(ClippingLevels, AreThoseThatJpegLeavesOfAPlateau) {
  const cv::Mat scene = light(1.3);
  for (const int quality : {60, 75, 85, 92, 97}) {
    for (const double plateau : {251.0, 253.0, 254.0, 255.0}) {
      const cv::Mat sensed = converted(scene, 8);
      const cv::Mat frame = through_jpeg(cv::min(sensed, plateau), quality);
      EXPECT_NEAR(clipped(frame), saturated(scene), 0.1) << quality << ", " << plateau;
      EXPECT_TRUE(is_found_clipped(frame)) << quality << ", " << plateau;
    }
  }
}

TEST(ClippingLevels, AreThoseOfARippleBelowFullScale) {
  cv::Mat frame = converted(light(0.5), 8);
  cv::Mat ripple(kHeight, kWidth / 4, CV_8UC3);
  cv::RNG(3).fill(ripple, cv::RNG::UNIFORM, 250, 255);
  ripple.copyTo(frame.colRange(0, kWidth / 4));
  EXPECT_NEAR(clipped(frame), 0.25, 0.001);
  EXPECT_TRUE(is_found_clipped(frame));
}

TEST(ClippingLevels, AreNotWhereAGoodFrameHappensToEnd) {
  for (const double brightness : {0.3, 0.6, 0.9, 0.95}) {
    const cv::Mat scene = cv::min(light(brightness), 0.999);
    EXPECT_LT(clipped(converted(scene, 16)), 1e-3) << brightness;
    for (const int bits : {10, 12, 14}) {
      EXPECT_LT(clipped(converted(scene, bits)), 1e-3) << brightness << ", " << bits;
      EXPECT_LT(clipped(converted(scene, bits, 16 - bits)), 1e-3) << brightness << ", " << bits;
    }
    const cv::Mat small = converted(scene, 8);
    EXPECT_LT(clipped(small), 1e-3) << brightness;
    for (const int quality : {60, 85, 95}) {
      EXPECT_LT(clipped(through_jpeg(small, quality)), 1e-3) << brightness << ", " << quality;
    }
  }
  // To a level of the converter's scale.
  cv::Mat dark = converted(light(0.5), 12);
  dark = cv::min(dark, 4000.0);
  for (const int full : {4095, 1023}) {
    cv::Mat frame = full == 4095 ? dark : dark / 4;
    frame.at<cv::Vec3w>(9, 9) = cv::Vec3w::all(static_cast<std::uint16_t>(full));
    EXPECT_LT(clipped(frame), 1e-3) << full;
  }
}

TEST(ClippingLevels, AreNotInMaterialThatIsNearlyWhiteButNotClipped) {
  EXPECT_LT(clipped(converted(light(0.983, 0.006), 8)), 0.03);
  EXPECT_LT(clipped(converted(light(0.983, 0.003), 12, 4)), 1e-3);
  EXPECT_LT(clipped(converted(light(0.983, 0.003), 12)), 1e-3);
  EXPECT_LT(clipped(converted(light(0.983, 0.003), 16)), 1e-3);
}

TEST(ClippingLevels, AreNotInAnEvenPictureFarFromTheEndOfAnyScale) {
  EXPECT_EQ(clipping_levels(cv::Mat(20, 20, CV_8UC3, cv::Scalar::all(200)))[0], 255);
  EXPECT_EQ(clipping_levels(cv::Mat(20, 20, CV_16UC3, cv::Scalar::all(3000)))[0], 65535);
  EXPECT_EQ(clipping_levels(cv::Mat(20, 20, CV_8UC3, cv::Scalar::all(0)))[0], 255);
  EXPECT_EQ(clipping_levels({})[0], 255);
}

TEST(ClippingLevels, AreOfEachColour) {
  cv::Mat scene = light(0.6);
  cv::Mat red;
  cv::extractChannel(scene, red, 0);
  cv::insertChannel(2.0 * red, scene, 0);
  EXPECT_EQ(clipping_levels(converted(scene, 12, 4)), (ClippingLevels{65520, 65535, 65535}));
}

// The plateau would smear over as many values as the flat field has, and be seen no more.
TEST(ClippingLevels, AreFoundBeforeAFrameIsCorrected) {
  const cv::Mat scene = light(1.3);
  cv::Mat flat(kHeight, kWidth, CV_16UC3);
  for (int x = 0; x < kWidth; ++x) {
    flat.col(x).setTo(cv::Scalar::all(40000.0 + 40.0 * std::abs(x - kWidth / 2)));
  }
  for (const bridge::Transfer transfer : {bridge::Transfer::linear, bridge::Transfer::srgb}) {
    cv::Mat shifted = converted(scene, 12, 4);
    acquisition::FieldCorrection(flat, {}, CV_16UC3, transfer).apply(shifted);
    EXPECT_GT(clipped(shifted), saturated(scene) - 0.01);
    cv::Mat coded = through_jpeg(cv::min(converted(scene, 8), 254.0), 92);
    acquisition::FieldCorrection(flat, {}, CV_8UC3, transfer).apply(coded);
    EXPECT_GT(clipped(coded), saturated(scene) - 0.1);
  }
  cv::Mat unshifted = converted(scene, 12);
  acquisition::FieldCorrection(flat, {}, CV_16UC3, bridge::Transfer::linear).apply(unshifted);
  EXPECT_NEAR(clipped(unshifted), saturated(scene), 0.01);
}

}  // namespace
}  // namespace biotomy::tests
