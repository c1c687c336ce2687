#include "sim/physics/defocus.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace biotomy::sim {
namespace {

TEST(Defocus, GrowsWithTheDistanceOnEitherSide) {
  const Lens lens;
  for (double away = 50; away < 2000; away += 50) {
    EXPECT_GT(blur_sigma_um(lens, away), blur_sigma_um(lens, away - 50));
    EXPECT_EQ(blur_sigma_um(lens, away), blur_sigma_um(lens, -away));
  }
}

TEST(Defocus, IsDiffractionInTheFocalPlaneAndGeometryFarFromIt) {
  EXPECT_NEAR(blur_sigma_um({0.1, 0.55}, 0), 1.2375, 1e-9);
  EXPECT_NEAR(blur_sigma_um({0.1, 0.55}, 1000), 2 * 0.1 * 1000 / 4, 0.1);
}

/// The measured spread of a point that was blurred by `sigma`.
double measured_sigma(double sigma) {
  cv::Mat picture(241, 241, CV_32FC3, cv::Scalar::all(0));
  picture.at<cv::Vec3f>(120, 120) = {1000, 1000, 1000};
  blur(picture, sigma);
  double sum = 0;
  double second = 0;
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const double level = picture.at<cv::Vec3f>(y, x)[1];
      sum += level;
      second += level * (x - 120) * (x - 120);
    }
  }
  return std::sqrt(second / sum);
}

TEST(Defocus, BlursByTheSigmaAskedForWhicheverWayItIsDone) {
  for (const double sigma : {0.1, 0.25, 0.36, 0.5, 0.8, 2.0, 3.9, 4.1, 8.0, 15.0}) {
    EXPECT_NEAR(measured_sigma(sigma), sigma, 0.08 * sigma) << sigma;
  }
}

/// The part of a wave's amplitude that is left; the wave has four pixels a period.
double contrast_left(double sigma) {
  constexpr std::array<float, 4> kWave{1, 0, -1, 0};
  cv::Mat picture(64, 64, CV_32FC3);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const float level = kWave[static_cast<std::size_t>(x % 4)];
      picture.at<cv::Vec3f>(y, x) = {level, level, level};
    }
  }
  blur(picture, sigma);
  return picture.at<cv::Vec3f>(32, 32)[0];
}

TEST(Defocus, TakesTheStatedContrastAtHalfTheNyquistFrequency) {
  for (const double sigma : {0.1, 0.25, 0.36, 0.5, 0.8, 1.2}) {
    EXPECT_NEAR(contrast_left(sigma), std::exp(-sigma * sigma), 0.005) << sigma;
    EXPECT_NEAR(contrast_at_half_nyquist(blur_weights(sigma)), contrast_left(sigma), 1e-4) << sigma;
  }
}

TEST(Defocus, StatesTheContrastThatASmearLeaves) {
  cv::Mat picture(16, 64, CV_32FC3);
  for (int x = 0; x < picture.cols; ++x) {
    picture.col(x).setTo(cv::Scalar::all(100.0 + 50.0 * (x % 4 == 0) - 50.0 * (x % 4 == 2)));
  }
  const auto swing = [](const cv::Mat& of) {
    return of.at<cv::Vec3f>(8, 32)[0] - of.at<cv::Vec3f>(8, 34)[0];
  };
  for (const double pixels : {0.7, 1.3, 2.0, 2.8}) {
    cv::Mat smeared = picture.clone();
    smear_along_rows(smeared, pixels);
    const double contrast = contrast_at_half_nyquist(smear_weights(pixels));
    EXPECT_NEAR(swing(smeared) / swing(picture), contrast, 1e-3) << pixels;
  }
}

TEST(Defocus, LeavesASharpPictureAlone) {
  cv::Mat picture(9, 9, CV_32FC3, cv::Scalar::all(0));
  picture.at<cv::Vec3f>(4, 4) = {1, 1, 1};
  const cv::Mat before = picture.clone();
  blur(picture, 0.01);
  EXPECT_EQ(cv::norm(picture, before), 0);
}

TEST(Defocus, SmearsMovementAlongTheRows) {
  cv::Mat picture(9, 41, CV_32FC3, cv::Scalar::all(0));
  picture.at<cv::Vec3f>(4, 20) = {5, 5, 5};
  smear_along_rows(picture, 5);
  EXPECT_FLOAT_EQ(picture.at<cv::Vec3f>(4, 22)[0], 1);
  EXPECT_FLOAT_EQ(picture.at<cv::Vec3f>(5, 20)[0], 0);
}

TEST(Defocus, SmearsByAPartOfAPixel) {
  cv::Mat picture(9, 41, CV_32FC3, cv::Scalar::all(0));
  picture.at<cv::Vec3f>(4, 20) = {5, 5, 5};
  smear_along_rows(picture, 2.5);
  EXPECT_FLOAT_EQ(picture.at<cv::Vec3f>(4, 20)[0], 2);
  EXPECT_FLOAT_EQ(picture.at<cv::Vec3f>(4, 21)[0], 1.5);
  EXPECT_FLOAT_EQ(picture.at<cv::Vec3f>(4, 19)[0], 1.5);
  EXPECT_FLOAT_EQ(picture.at<cv::Vec3f>(4, 22)[0], 0);
}

}  // namespace
}  // namespace biotomy::sim
