#include "acquisition/quality/camera_noise.hpp"

#include <array>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "acquisition/quality/median.hpp"
#include "sim/physics/colour_mosaic.hpp"
#include "tests/acquisition/quality/phantom_photographer.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

/// A plain surface with photon noise, which `seed` draws; from left to right the light may grow.
cv::Mat plain(int seed, bool mosaic, cv::Size size = {640, 480}, double growth = 0.0) {
  cv::Mat light(size, CV_32FC3);
  for (int x = 0; x < size.width; ++x) {
    light.col(x).setTo(cv::Scalar::all(40.0 + growth * x / size.width));
  }
  cv::Mat noise(size, CV_32FC3);
  cv::RNG(static_cast<std::uint64_t>(seed)).fill(noise, cv::RNG::NORMAL, 0.0, 0.25);
  cv::Mat deviation;
  cv::sqrt(light, deviation);
  cv::Mat image;
  cv::Mat(light + noise.mul(deviation)).convertTo(image, CV_16UC3, 257.0);
  if (mosaic) sim::interpolate_mosaic(image);
  return image;
}

std::vector<double> detail_over_noise(const FrameMeasures& measures, DetailBand band) {
  std::vector<double> ratios;
  for (const TileMeasures& tile : measures.tiles) {
    ratios.push_back(tile.detail(band).sum() / (2.0 * tile.noise[band]));
  }
  return ratios;
}

TEST(CameraNoise, IsToldWhereColoursAreInterpolatedFromAMosaic) {
  const FrameMeasures one = measure_frame(plain(1, true));
  const auto noise = noise_between(one, measure_frame(plain(2, true)));
  ASSERT_TRUE(noise);
  const FrameMeasures other = measure_frame(plain(3, true));
  // How often a band has the noise that the frame alone lets expect; the rest passes for detail.
  constexpr std::array kTimes = {std::pair{DetailBand::fine, 14.0},
                                 std::pair{DetailBand::middle, 26.0},
                                 std::pair{DetailBand::coarse, 33.0}};
  const FrameMeasures corrected = with_noise(other, *noise);
  for (const auto& [band, times] : kTimes) {
    EXPECT_NEAR(median(detail_over_noise(other, band)), times - 1.0, 0.1 * times);
    EXPECT_NEAR(median(detail_over_noise(corrected, band)), 0.0, 0.05);
  }
  EXPECT_TRUE(noise->face);
}

TEST(CameraNoise, IsToldWhereACameraCompressesItsPictures) {
  const auto compressed = [](int seed) {
    cv::Mat image;
    plain(seed, false).convertTo(image, CV_8UC3, 1.0 / 257.0);
    std::vector<unsigned char> bytes;
    cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, 90});
    return measure_frame(cv::imdecode(bytes, cv::IMREAD_COLOR));
  };
  const auto noise = noise_between(compressed(1), compressed(2));
  ASSERT_TRUE(noise);
  EXPECT_FALSE(is_white(*noise));
  const FrameMeasures other = compressed(3);
  EXPECT_GT(median(detail_over_noise(other, DetailBand::fine)), 2.0);
  EXPECT_NEAR(median(detail_over_noise(with_noise(other, *noise), DetailBand::fine)), 0.0, 0.05);
}

TEST(CameraNoise, GrowsWithTheLight) {
  const auto frame = [](int seed) { return measure_frame(plain(seed, true, {640, 480}, 150.0)); };
  const auto noise = noise_between(frame(1), frame(2));
  ASSERT_TRUE(noise);
  const BandNoise& fine = noise->bands[DetailBand::fine];
  EXPECT_NEAR(fine.at(0.6) / fine.at(0.2), 3.0, 0.4);
}

TEST(CameraNoise, ThatIsWhiteLeavesToEachTileWhatItTellsOfItself) {
  const FrameMeasures one = measure_frame(plain(1, false));
  const auto white = noise_between(one, measure_frame(plain(2, false)));
  const auto coloured = noise_between(measure_frame(plain(1, true)), measure_frame(plain(2, true)));
  ASSERT_TRUE(white && coloured);
  EXPECT_TRUE(is_white(*white));
  EXPECT_FALSE(is_white(*coloured));
  const double own = one.tiles.front().noise[DetailBand::fine];
  const FrameMeasures mistaken = with_noise(one, *coloured);
  EXPECT_NE(mistaken.tiles.front().noise[DetailBand::fine], own);
  EXPECT_EQ(with_noise(mistaken, *white).tiles.front().noise[DetailBand::fine], own);
}

TEST(CameraNoise, IsNotToldByTooFewPixelsOrFramesOfTwoSizes) {
  const cv::Size small(128, 96);
  EXPECT_FALSE(
      noise_between(measure_frame(plain(1, true, small)), measure_frame(plain(2, true, small))));
  EXPECT_FALSE(noise_between(measure_frame(plain(1, true)), measure_frame(plain(2, true, small))));
}

TEST(CameraNoise, IsToldAllTheSameByAFaceThatMovedALittle) {
  PhantomPhotographer camera({.width = 640, .height = 480, .sensor = {.mosaic = true}});
  const auto still = noise_between(measure_frame(camera.photograph(100.0)),
                                   measure_frame(camera.photograph(100.0)));
  const auto moved = noise_between(measure_frame(camera.photograph(100.0)),
                                   measure_frame(camera.photograph(100.0, 0.1, 0.05)));
  ASSERT_TRUE(still && moved);
  const auto at_half = [](const CameraNoise& noise) {
    return noise.bands[DetailBand::fine].at(0.5);
  };
  EXPECT_NEAR(at_half(*moved) / at_half(*still), 1.0, 0.3);
}

}  // namespace
}  // namespace biotomy::tests
