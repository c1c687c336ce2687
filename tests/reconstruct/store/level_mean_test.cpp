#include "reconstruct/store/level_mean.hpp"

#include <gtest/gtest.h>

#include "tests/reconstruct/test_images.hpp"
#include "tests/reconstruct/volume_levels.hpp"

namespace biotomy::reconstruct {
namespace {

std::vector<cv::Mat> some_layers(int count, cv::Size size, int type) {
  std::vector<cv::Mat> layers;
  for (int k = 0; k < count; ++k) {
    layers.push_back(test_image(size.width, size.height, type, static_cast<std::uint64_t>(k + 1)));
  }
  return layers;
}

TEST(LevelMean, IsTheMeanOfEveryCombinationOfHalvedAxesAtOddAndEvenSizes) {
  for (const int type : {CV_8UC3, CV_16UC3}) {
    for (const cv::Size size : {cv::Size(7, 5), cv::Size(8, 6), cv::Size(1, 1)}) {
      for (int axes = 0; axes < 8; ++axes) {
        for (const int count : {1, 2, 5}) {
          const HalvedAxes halved{(axes & 1) != 0, (axes & 2) != 0, (axes & 4) != 0};
          const LevelFactor step{halved.x ? 2 : 1, halved.y ? 2 : 1, halved.z ? 2 : 1};
          const Cuboid finest{{size.width, size.height, count}, {1, 1, 1}};
          const auto layers = some_layers(count, size, type);
          const auto expected =
              slow_next_level(layers, pyramid_level(finest, {}), pyramid_level(finest, step));
          const auto means = level_mean(layers, halved);
          ASSERT_EQ(means.size(), expected.size());
          for (std::size_t k = 0; k < means.size(); ++k) {
            ASSERT_TRUE(same_pixels(means[k], expected[k]))
                << size << " of " << count << ", axes " << axes << ", layer " << k;
          }
        }
      }
    }
  }
}

TEST(LevelMean, OfTheBrightestValuesIsThatValue) {
  for (const auto& [type, brightest] : {std::pair(CV_8UC3, 255), std::pair(CV_16UC3, 65535)}) {
    const cv::Mat layer(4, 4, type, cv::Scalar::all(brightest));
    const auto means = level_mean({layer, layer}, {true, true, true});
    ASSERT_EQ(means.size(), 1U);
    EXPECT_TRUE(same_pixels(means[0], cv::Mat(2, 2, type, cv::Scalar::all(brightest))));
  }
}

TEST(LevelMean, RoundsAHalfUpwardsAndOnlyOnce) {
  cv::Mat layer(2, 2, CV_8UC3, cv::Scalar::all(0));
  layer.at<cv::Vec3b>(0, 0) = {1, 2, 3};  // sums over 4: 0.25, 0.5, 0.75
  EXPECT_EQ(level_mean({layer}, {true, true, false})[0].at<cv::Vec3b>(0, 0), cv::Vec3b(0, 1, 1));
}

TEST(LevelMean, HalvesTheAxesWhoseFactorGrows) {
  const HalvedAxes axes = halved_axes({2, 2, 1}, {4, 2, 2});
  EXPECT_TRUE(axes.x);
  EXPECT_FALSE(axes.y);
  EXPECT_TRUE(axes.z);
}

}  // namespace
}  // namespace biotomy::reconstruct
