#include "acquisition/quality/sharpness_comparison.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/acquisition/quality/phantom_photographer.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using Frame = std::shared_ptr<const FrameMeasures>;

Frame measured(const cv::Mat& image) {
  return std::make_shared<const FrameMeasures>(measure_frame(image));
}

constexpr PhotographerSettings kJoint{.width = 480, .height = 480};

/// Out of focus so far that exp(-σ²) = 0.85 of the contrast at half the Nyquist frequency is left:
/// σ² grows by (0.05 · defocus / pixel)², see sim/physics/defocus.hpp.
const double kLosing15Percent = 10.0 / 0.05 * std::sqrt(-std::log(0.85));

SharpnessComparison compared(const Frame& frame, const std::vector<Frame>& references) {
  const auto comparison = compare_sharpness(*frame, references, 0.92);
  if (!comparison) throw std::runtime_error("nothing was compared");
  return *comparison;
}

TEST(SharpnessComparison, OfTheSameFaceIsOne) {
  PhantomPhotographer camera(kJoint);
  const Frame reference = measured(camera.photograph(100.0));
  const SharpnessComparison same = compared(measured(camera.photograph(100.0)), {reference});
  EXPECT_NEAR(same.ratio.value, 1.0, 0.01);
  EXPECT_NEAR(same.anisotropy.value, 1.0, 0.02);
  EXPECT_LT(same.below, same.tiles / 10);
}

TEST(SharpnessComparison, SeesABlurThatTakesASeventhOfTheContrastWhateverTheLayer) {
  PhantomPhotographer camera(kJoint);
  std::vector<Frame> before;
  for (int layer = 0; layer < 24; ++layer) {
    const double depth = 20.0 * layer;
    if (before.size() == 8) {
      const SharpnessComparison good = compared(measured(camera.photograph(depth)), before);
      EXPECT_GT(good.ratio.value * std::exp(good.ratio.error), 0.93) << layer;
      const SharpnessComparison blurred =
          compared(measured(camera.photograph(depth, 0.0, 0.0, kLosing15Percent)), before);
      EXPECT_LT(blurred.ratio.value * std::exp(blurred.ratio.error), 0.93) << layer;
      EXPECT_GT(blurred.below, blurred.tiles / 2);
      before.erase(before.begin());
    }
    before.push_back(measured(camera.photograph(depth)));
  }
}

TEST(SharpnessComparison, DependsNeitherOnTheLampNorOnNoise) {
  PhantomPhotographer camera(kJoint);
  PhotographerSettings grainy = kJoint;
  grainy.sensor.photons_at_white = 4000.0;
  const Frame reference = measured(camera.photograph(100.0));
  const cv::Mat dim = 0.6 * camera.photograph(100.0);
  EXPECT_NEAR(compared(measured(dim), {reference}).ratio.value, 1.0, 0.03);
  const cv::Mat noisy = PhantomPhotographer(grainy).photograph(100.0);
  EXPECT_NEAR(compared(measured(noisy), {reference}).ratio.value, 1.0, 0.03);
}

TEST(SharpnessComparison, TellsASmearFromABlur) {
  PhantomPhotographer camera(kJoint);
  const cv::Mat sharp = camera.photograph(100.0);
  cv::Mat smeared;
  cv::blur(sharp, smeared, {3, 1});
  cv::Mat blurred;
  cv::GaussianBlur(sharp, blurred, {7, 7}, 0.8);
  const Frame reference = measured(sharp);
  EXPECT_LT(compared(measured(smeared), {reference}).anisotropy.value, 0.85);
  EXPECT_GT(compared(measured(blurred), {reference}).anisotropy.value, 0.95);
}

TEST(SharpnessComparison, OfContrastSeesABlurThatLeavesNothingButNoise) {
  PhantomPhotographer camera(kJoint);
  const cv::Mat sharp = camera.photograph(0.0);
  cv::Mat blurred;
  cv::GaussianBlur(sharp, blurred, {}, 8.0);
  cv::Mat noise(sharp.size(), CV_16SC3);
  cv::RNG(3).fill(noise, cv::RNG::NORMAL, 0.0, 3.0);
  cv::add(blurred, noise, blurred, cv::noArray(), CV_8UC3);
  const std::vector<Frame> before{measured(sharp)};
  EXPECT_LT(compare_contrast(*measured(blurred), before).value(), 0.3);
  EXPECT_NEAR(compare_contrast(*measured(sharp * 0.97), before).value(), 1.0, 0.02)
      << "the lamp makes no difference";
  EXPECT_NEAR(compare_contrast(*measured(camera.photograph(20.0)), before).value(), 1.0, 0.1);
}

TEST(SharpnessComparison, OfContrastNeedsTilesOfTheSameColour) {
  PhantomPhotographer camera(kJoint);
  const cv::Mat image = camera.photograph(0.0);
  cv::Mat other;
  cv::cvtColor(image, other, cv::COLOR_RGB2BGR);
  EXPECT_FALSE(compare_contrast(*measured(other), std::vector{measured(image)}));
}

TEST(SharpnessComparison, NeedsDetail) {
  cv::Mat bare(240, 240, CV_8UC3, cv::Scalar(60, 120, 80));
  cv::Mat noise(bare.size(), CV_16SC3);
  cv::RNG(3).fill(noise, cv::RNG::NORMAL, 0.0, 1.5);
  cv::add(bare, noise, bare, cv::noArray(), CV_8UC3);
  const Frame frame = measured(bare);
  EXPECT_FALSE(compare_sharpness(*frame, std::vector{frame}, 0.92));
}

TEST(SharpnessComparison, NeedsFramesOfOneSize) {
  PhantomPhotographer camera(kJoint);
  const cv::Mat image = camera.photograph(0.0);
  const Frame half = measured(image(cv::Rect(0, 0, 240, 480)));
  EXPECT_FALSE(compare_sharpness(*measured(image), std::vector{half}, 0.92));
}

TEST(Sharpness, OfABlackPictureIsZero) {
  EXPECT_EQ(sharpness(measure_frame(cv::Mat(64, 64, CV_8UC3, cv::Scalar::all(0)))), 0.0);
}

}  // namespace
}  // namespace biotomy::tests
