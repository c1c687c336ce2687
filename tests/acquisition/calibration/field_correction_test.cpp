#include "acquisition/calibration/field_correction.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "acquisition/calibration/light.hpp"

namespace biotomy::tests {
namespace {

using acquisition::FieldCorrection;
using acquisition::light_of;
using bridge::Transfer;

constexpr int kWidth = 67;  // not a multiple of a vector
constexpr int kHeight = 41;

/// Values that have nothing in common, CV_64FC3.
cv::Mat random_values(double least, double most, std::uint64_t seed) {
  cv::Mat values(kHeight, kWidth, CV_64FC3);
  cv::RNG(seed).fill(values, cv::RNG::UNIFORM, least, most);
  return values;
}

cv::Mat stored(const cv::Mat& values, int type) {
  cv::Mat result;
  values.convertTo(result, type);
  return result;
}

/// The formula itself, of the values as they are stored.
cv::Mat reference(const cv::Mat& image, const cv::Mat& flat, const cv::Mat& dark) {
  cv::Mat frame;
  cv::Mat light;
  cv::Mat none = cv::Mat::zeros(image.size(), CV_64FC3);
  const double level = image.depth() == CV_8U ? 257.0 : 1.0;
  image.convertTo(frame, CV_64F, level);
  flat.convertTo(light, CV_64F);
  if (!dark.empty()) dark.convertTo(none, CV_64F);
  light -= none;
  frame -= none;
  const cv::Scalar mean = cv::mean(light);
  cv::Mat corrected(image.size(), CV_64FC3);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double value =
            frame.at<cv::Vec3d>(y, x)[c] * mean[c] / light.at<cv::Vec3d>(y, x)[c] / level;
        corrected.at<cv::Vec3d>(y, x)[c] =
            std::clamp(value, 0.0, image.depth() == CV_8U ? 255.0 : 65535.0);
      }
    }
  }
  return corrected;
}

double largest_difference(const cv::Mat& image, const cv::Mat& expected) {
  cv::Mat values;
  image.convertTo(values, CV_64F);
  return cv::norm(values, expected, cv::NORM_INF);
}

class Fields : public testing::TestWithParam<bool> {
 protected:
  cv::Mat flat = stored(random_values(25000.0, 50000.0, 1), CV_16UC3);
  cv::Mat dark = GetParam() ? stored(random_values(0.0, 1500.0, 2), CV_16UC3) : cv::Mat();
};

TEST_P(Fields, CorrectFramesOfEightBitsToTheNearestLevel) {
  cv::Mat image = stored(random_values(0.0, 180.0, 3), CV_8UC3);
  const cv::Mat expected = reference(image, flat, dark);
  FieldCorrection(flat, dark, CV_8UC3, Transfer::linear).apply(image);
  EXPECT_LT(largest_difference(image, expected), 0.55);  // half a level, and a little of rounding
}

TEST_P(Fields, CorrectFramesOfSixteenBits) {
  cv::Mat image = stored(random_values(0.0, 45000.0, 4), CV_16UC3);
  const cv::Mat expected = reference(image, flat, dark);
  FieldCorrection(flat, dark, CV_16UC3, Transfer::linear).apply(image);
  EXPECT_LT(largest_difference(image, expected), 3.0);  // of 65535
}

TEST_P(Fields, MakeThePictureOfAnEvenSurfaceEven) {
  cv::Mat image;
  flat.convertTo(image, CV_8U, 1.0 / 257.0);
  FieldCorrection(flat, dark, CV_8UC3, Transfer::linear).apply(image);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(image, mean, deviation);
  for (int c = 0; c < 3; ++c) EXPECT_LT(deviation[c], 0.7) << c;
}

TEST_P(Fields, KeepClippedValuesClippedAndBlackOnesBlack) {
  cv::Mat full(kHeight, kWidth, CV_8UC3, cv::Scalar::all(255));
  FieldCorrection(flat, dark, CV_8UC3, Transfer::linear).apply(full);
  EXPECT_EQ(cv::countNonZero(full.reshape(1) != 255), 0);
  cv::Mat deep(kHeight, kWidth, CV_16UC3, cv::Scalar::all(65535));
  FieldCorrection(flat, dark, CV_16UC3, Transfer::linear).apply(deep);
  EXPECT_EQ(cv::countNonZero(deep.reshape(1) != 65535), 0);
  cv::Mat black(kHeight, kWidth, CV_8UC3, cv::Scalar::all(0));
  FieldCorrection(flat, dark, CV_8UC3, Transfer::linear).apply(black);
  EXPECT_EQ(cv::countNonZero(black.reshape(1)), 0);
}

TEST_P(Fields, ClipWhatBecomesTooBright) {
  flat.rowRange(0, kHeight / 2).setTo(cv::Scalar::all(60000));
  flat.rowRange(kHeight / 2, kHeight).setTo(cv::Scalar::all(20000));
  dark = cv::Mat();
  cv::Mat image(kHeight, kWidth, CV_8UC3, cv::Scalar::all(200));
  FieldCorrection(flat, dark, CV_8UC3, Transfer::linear).apply(image);
  EXPECT_EQ(image.at<cv::Vec3b>(kHeight - 1, 0), cv::Vec3b(255, 255, 255));
  cv::Mat deep(kHeight, kWidth, CV_16UC3, cv::Scalar::all(60000));
  FieldCorrection(flat, dark, CV_16UC3, Transfer::linear).apply(deep);
  EXPECT_EQ(deep.at<cv::Vec3w>(kHeight - 1, 0), cv::Vec3w(65535, 65535, 65535));
}

/// What a camera shows of so much light, of 1.
double srgb(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055;
}

/// As the camera shows it, at a scale of so much.
cv::Mat coded(const cv::Mat& light, double full) {
  cv::Mat values = light.clone();
  values.forEach<cv::Vec3d>([&](cv::Vec3d& value, const int*) {
    for (int c = 0; c < 3; ++c) value[c] = full * srgb(value[c] / 65535.0);
  });
  return values;
}

TEST_P(Fields, CorrectTheLightOfCodedFrames) {
  const cv::Mat light = stored(random_values(100.0, 45000.0, 5), CV_16UC3);
  const cv::Mat expected = reference(light, flat, dark);
  cv::Mat image = stored(coded(random_values(100.0, 45000.0, 5), 65535.0), CV_16UC3);
  FieldCorrection(flat, dark, CV_16UC3, Transfer::srgb).apply(image);
  EXPECT_LT(largest_difference(image, coded(expected, 65535.0)), 32.0);  // of 65535, near black
  // The levels of eight bits that the camera rounds to are what the formula is given.
  cv::Mat small = stored(coded(random_values(100.0, 45000.0, 5), 255.0), CV_8UC3);
  const cv::Mat seen = light_of(small, Transfer::srgb);
  const cv::Mat wanted = coded(reference(seen, flat, dark), 255.0);
  FieldCorrection(flat, dark, CV_8UC3, Transfer::srgb).apply(small);
  EXPECT_LT(largest_difference(small, wanted), 0.6);
}

TEST_P(Fields, KeepClippedValuesOfCodedFramesClippedAndBlackOnesBlack) {
  for (const int type : {CV_8UC3, CV_16UC3}) {
    const int full = type == CV_8UC3 ? 255 : 65535;
    cv::Mat image(kHeight, kWidth, type, cv::Scalar(full, 0, full));
    FieldCorrection(flat, dark, type, Transfer::srgb).apply(image);
    EXPECT_EQ(cv::norm(image, cv::Mat(image.size(), type, cv::Scalar(full, 0, full))), 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(, Fields, testing::Bool(),
                         [](const auto& with) { return with.param ? "WithDark" : "WithoutDark"; });

TEST(FieldCorrection, WithADarkFieldAloneSubtractsIt) {
  const cv::Mat dark(kHeight, kWidth, CV_16UC3, cv::Scalar::all(3.0 * 257.0));
  cv::Mat image(kHeight, kWidth, CV_8UC3, cv::Scalar(100, 3, 1));
  FieldCorrection({}, dark, CV_8UC3, Transfer::linear).apply(image);
  EXPECT_EQ(image.at<cv::Vec3b>(5, 5), cv::Vec3b(97, 0, 0));
}

/// A level of eight bits for so much light.
int level(double light) {
  return static_cast<int>(std::lround(255.0 * srgb(light)));
}

TEST(FieldCorrection, GivesTissueInADarkCornerItsLightBackBehindTheCurve) {
  cv::Mat flat(kHeight, kWidth, CV_16UC3, cv::Scalar::all(0.6 * 65535.0));
  flat.at<cv::Vec3w>(0, 0) = cv::Vec3w::all(0.3 * 65535.0);
  cv::Mat image(kHeight, kWidth, CV_8UC3, cv::Scalar::all(level(0.05)));
  image.at<cv::Vec3b>(0, 0) = cv::Vec3b::all(static_cast<std::uint8_t>(level(0.025)));
  FieldCorrection(flat, {}, CV_8UC3, Transfer::srgb).apply(image);
  EXPECT_NEAR(image.at<cv::Vec3b>(9, 9)[0], level(0.05), 1);
  EXPECT_NEAR(image.at<cv::Vec3b>(0, 0)[0], level(0.05), 1);
}

TEST(FieldCorrection, TakesOffWhatTheSensorAddsToTheLightBehindTheCurve) {
  const cv::Mat dark(kHeight, kWidth, CV_16UC3, cv::Scalar::all(0.003 * 65535.0));
  cv::Mat image(kHeight, kWidth, CV_8UC3, cv::Scalar::all(level(0.053)));
  image.row(0).setTo(cv::Scalar::all(level(0.003)));
  FieldCorrection({}, dark, CV_8UC3, Transfer::srgb).apply(image);
  EXPECT_NEAR(image.at<cv::Vec3b>(9, 9)[0], level(0.05), 1);
  EXPECT_LE(image.at<cv::Vec3b>(0, 9)[0], 1);
}

TEST(FieldCorrection, AmplifiesNoFurtherWhereThereIsHardlyAnyLight) {
  cv::Mat flat(kHeight, kWidth, CV_16UC3, cv::Scalar::all(40000));
  flat.at<cv::Vec3w>(7, 7) = cv::Vec3w(0, 1, 9000);
  cv::Mat image(kHeight, kWidth, CV_8UC3, cv::Scalar::all(20));
  FieldCorrection(flat, {}, CV_8UC3, Transfer::linear).apply(image);
  EXPECT_EQ(image.at<cv::Vec3b>(7, 7), cv::Vec3b(80, 80, 80));
}

}  // namespace
}  // namespace biotomy::tests
