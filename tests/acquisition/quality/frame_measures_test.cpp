#include "acquisition/quality/frame_measures.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace biotomy::tests {
namespace {

using namespace acquisition;

/// A wave along x, of f cycles per pixel and an amplitude of `levels` of 65535.
cv::Mat wave(double f, double levels, int width = 384, int height = 256) {
  cv::Mat image(height, width, CV_16UC3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double level =
          30000.0 + levels * std::sin(2.0 * std::numbers::pi * f * static_cast<double>(x));
      image.at<cv::Vec3w>(y, x) = cv::Vec3w::all(static_cast<std::uint16_t>(std::lround(level)));
    }
  }
  return image;
}

cv::Mat grey(cv::Size size, int level) {
  return cv::Mat(size, CV_8UC3, cv::Scalar::all(level));
}

void add_noise(cv::Mat& image, double sigma) {
  cv::Mat noise(image.size(), CV_32FC3);
  cv::RNG(7).fill(noise, cv::RNG::NORMAL, 0.0, sigma);
  cv::Mat sum;
  image.convertTo(sum, CV_32FC3);
  sum += noise;
  sum.convertTo(image, image.type());
}

TEST(TileGrid, CoversTheFrameWithoutGapOrOverlap) {
  for (const cv::Size frame : {cv::Size(5472, 3648), cv::Size(801, 599), cv::Size(64, 48),
                               cv::Size(17, 300), cv::Size(1, 1)}) {
    const TileGrid grid = TileGrid::of(frame);
    cv::Mat count(frame, CV_8U, cv::Scalar(0));
    for (int i = 0; i < grid.count(); ++i) count(grid.tile(i)) += 1;
    EXPECT_EQ(cv::countNonZero(count != 1), 0) << frame;
  }
}

TEST(TileGrid, HasSomeHundredTilesOfALargeFrameAndFewerOfASmallOne) {
  EXPECT_NEAR(TileGrid::of({5472, 3648}).count(), 96, 12);
  EXPECT_LE(TileGrid::of({64, 48}).count(), 12);
  EXPECT_EQ(TileGrid::of({}).count(), 0);
}

TEST(FrameMeasures, AreThoseOfAWave) {
  constexpr double kFrequency = 0.125;
  constexpr double kAmplitude = 10000.0 / 65535.0;
  const FrameMeasures measures = measure_frame(wave(kFrequency, 10000.0));
  const double omega = 2.0 * std::numbers::pi * kFrequency;
  const double power = 0.5 * kAmplitude * kAmplitude;
  for (const TileMeasures& tile : measures.tiles) {
    // A wave along x alone has no energy under the checkered kernel of the noise.
    EXPECT_NEAR(tile.noise[DetailBand::fine], 0.0, 1e-9);
    EXPECT_NEAR(tile.detail(DetailBand::fine).along_x / (power * std::pow(std::sin(omega), 2)), 1.0,
                0.06);
    EXPECT_NEAR(tile.detail(DetailBand::curvature).along_x /
                    (power * std::pow(2.0 - 2.0 * std::cos(omega), 2)),
                1.0, 0.06);
    EXPECT_NEAR(tile.detail(DetailBand::fine).along_y, 0.0, 1e-6);
    EXPECT_NEAR(tile.detail(DetailBand::curvature).along_y, 0.0, 1e-6);
  }
}

TEST(FrameMeasures, OfNoiseAloneAreNoDetail) {
  cv::Mat image = grey({768, 512}, 120);
  add_noise(image, 3.0);
  // The mean of three colours' noise, weighted 1, 2, 1.
  const double sigma = 3.0 / 255.0 * std::sqrt(6.0) / 4.0;
  const FrameMeasures measures = measure_frame(image);
  for (const TileMeasures& tile : measures.tiles) {
    EXPECT_NEAR(tile.noise[DetailBand::fine] / (sigma * sigma), 3.0 / 16.0, 0.03);
    EXPECT_NEAR(tile.detail(DetailBand::fine).sum() / (sigma * sigma), 0.0, 0.06);
    EXPECT_NEAR(tile.detail(DetailBand::curvature).sum() / (sigma * sigma), 0.0, 1.0);
    EXPECT_NEAR(tile.detail(DetailBand::middle).sum() / (sigma * sigma), 0.0, 0.06);
    EXPECT_NEAR(tile.detail(DetailBand::coarse).sum() / (sigma * sigma), 0.0, 0.06);
    EXPECT_LT(tile.signal_to_noise(), 0.2);
  }
}

TEST(FrameMeasures, LeaveOutWhatIsSaturatedAndItsEdges) {
  const cv::Mat plain = wave(0.1, 8000.0);
  cv::Mat spotted = plain.clone();
  for (int y = 16; y < spotted.rows; y += 32) {
    for (int x = 16; x < spotted.cols; x += 32) {
      spotted(cv::Rect(x, y, 6, 6)).setTo(cv::Scalar(65535, 65535, 65535));
    }
  }
  const FrameMeasures without = measure_frame(plain);
  const FrameMeasures with = measure_frame(spotted);
  for (std::size_t i = 0; i < with.tiles.size(); ++i) {
    EXPECT_GT(with.tiles[i].clipped, 0.01);
    EXPECT_NEAR(with.tiles[i].detail(DetailBand::fine).sum() /
                    without.tiles[i].detail(DetailBand::fine).sum(),
                1.0, 0.1);
    EXPECT_NEAR(with.tiles[i].detail(DetailBand::curvature).sum() /
                    without.tiles[i].detail(DetailBand::curvature).sum(),
                1.0, 0.1);
  }
}

TEST(FrameMeasures, OfAWhitePictureAreNothingAndNumbersAllTheSame) {
  const FrameMeasures measures = measure_frame(grey({256, 192}, 255));
  for (const TileMeasures& tile : measures.tiles) {
    EXPECT_DOUBLE_EQ(tile.clipped, 1.0);
    EXPECT_DOUBLE_EQ(tile.brightness(), 0.0);
    EXPECT_DOUBLE_EQ(tile.detail(DetailBand::fine).sum(), 0.0);
  }
}

TEST(FrameMeasures, TakeFramesOfAnySize) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(2, 40), cv::Size(5, 5), cv::Size(33, 17)}) {
    const FrameMeasures measures = measure_frame(grey(size, 90));
    ASSERT_EQ(measures.tiles.size(), static_cast<std::size_t>(measures.grid.count()));
    for (const TileMeasures& tile : measures.tiles) {
      EXPECT_NEAR(tile.brightness(), 90.0 / 255.0, 1e-6);
      EXPECT_TRUE(std::isfinite(tile.detail(DetailBand::fine).sum() +
                                tile.detail(DetailBand::coarse).sum()));
    }
  }
  EXPECT_TRUE(measure_frame({}).tiles.empty());
}

TEST(FrameMeasures, KnowTheColours) {
  cv::Mat image(200, 300, CV_8UC3, cv::Scalar(51, 102, 204));
  for (const TileMeasures& tile : measure_frame(image).tiles) {
    EXPECT_NEAR(tile.mean[0], 0.2, 1e-9);
    EXPECT_NEAR(tile.mean[1], 0.4, 1e-9);
    EXPECT_NEAR(tile.mean[2], 0.8, 1e-9);
  }
}

}  // namespace
}  // namespace biotomy::tests
