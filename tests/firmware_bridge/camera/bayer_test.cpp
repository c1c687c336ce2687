#include "firmware_bridge/camera/bayer.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace biotomy::bridge {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kSide = 8;
constexpr RawColours kLinear{.is_srgb = false};

/// A frame of one colour as a sensor of that order sees it; values of `format.bits`.
Bytes mosaic(const BayerFormat& format, const std::string& order, int red, int green, int blue,
             std::size_t stride) {
  Bytes bytes(stride * kSide);
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const char colour = order[static_cast<std::size_t>(2 * (row % 2) + column % 2)];
      const int value = colour == 'R' ? red : colour == 'B' ? blue : green;
      std::uint8_t* line = bytes.data() + static_cast<std::size_t>(row) * stride;
      if (format.is_packed && format.bits == 10) {
        std::uint8_t* group = line + column / 4 * 5;
        group[column % 4] = static_cast<std::uint8_t>(value >> 2);
        group[4] = static_cast<std::uint8_t>(group[4] | (value & 3) << 2 * (column % 4));
      } else if (format.is_packed) {
        std::uint8_t* group = line + column / 2 * 3;
        group[column % 2] = static_cast<std::uint8_t>(value >> 4);
        group[2] = static_cast<std::uint8_t>(group[2] | (value & 15) << 4 * (column % 2));
      } else if (format.bits == 8) {
        line[column] = static_cast<std::uint8_t>(value);
      } else {
        line[2 * column] = static_cast<std::uint8_t>(value & 255);
        line[2 * column + 1] = static_cast<std::uint8_t>(value >> 8);
      }
    }
  }
  return bytes;
}

void expect_everywhere(const cv::Mat& image, int red, int green, int blue) {
  ASSERT_EQ(image.type(), CV_16UC3);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column) {
      const auto& colour = image.at<cv::Vec3w>(row, column);
      ASSERT_NEAR(colour[0], red, 1) << row << ", " << column;
      ASSERT_NEAR(colour[1], green, 1) << row << ", " << column;
      ASSERT_NEAR(colour[2], blue, 1) << row << ", " << column;
    }
  }
}

TEST(BayerFormat, IsReadFromItsName) {
  EXPECT_EQ(bayer_format("SRGGB8"), (BayerFormat{BayerOrder::rggb, 8, false}));
  EXPECT_EQ(bayer_format("SGRBG10"), (BayerFormat{BayerOrder::grbg, 10, false}));
  EXPECT_EQ(bayer_format("SGBRG12_CSI2P"), (BayerFormat{BayerOrder::gbrg, 12, true}));
  EXPECT_EQ(bayer_format("SBGGR16"), (BayerFormat{BayerOrder::bggr, 16, false}));
}

TEST(BayerFormat, IsNothingElse) {
  for (const char* name : {"", "S", "RGB888", "SRGGB", "SRGGB9", "SRGGB10_IPU3", "SRGGB8_CSI2P",
                           "SRGGB16_CSI2P", "SRRGB10", "R10_CSI2P", "MJPEG", "SRGGB10 "}) {
    EXPECT_FALSE(bayer_format(name)) << name;
  }
}

struct RawCase {
  const char* name;
  const char* order;
  std::size_t stride;
};

class RawFrame : public testing::TestWithParam<RawCase> {};

TEST_P(RawFrame, BecomesItsColour) {
  const BayerFormat format = *bayer_format(GetParam().name);
  const int most = (1 << format.bits) - 1;
  const Bytes bytes = mosaic(format, GetParam().order, most, most / 3, most / 5, GetParam().stride);
  const cv::Mat image = demosaic(format, kSide, kSide, {bytes, GetParam().stride}, kLinear);
  expect_everywhere(image, 65535, static_cast<int>(65535LL * (most / 3) / most),
                    static_cast<int>(65535LL * (most / 5) / most));
}

INSTANTIATE_TEST_SUITE_P(
    Layouts, RawFrame,
    testing::Values(RawCase{"SRGGB8", "RGGB", 8}, RawCase{"SGRBG8", "GRBG", 11},
                    RawCase{"SGBRG10", "GBRG", 16}, RawCase{"SBGGR12", "BGGR", 20},
                    RawCase{"SRGGB14", "RGGB", 16}, RawCase{"SGRBG16", "GRBG", 16},
                    RawCase{"SRGGB10_CSI2P", "RGGB", 10}, RawCase{"SBGGR10_CSI2P", "BGGR", 16},
                    RawCase{"SGBRG12_CSI2P", "GBRG", 12}, RawCase{"SGRBG12_CSI2P", "GRBG", 16}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Demosaic, PutsEachValueOfAPackedFrameInItsPlace) {
  // A step between the second and third of four packed columns: what a pixel measured itself is
  // kept as it is.
  const BayerFormat format{BayerOrder::rggb, 10, true};
  Bytes bytes(10 * kSide, 0);
  for (int row = 0; row < kSide; ++row) {
    std::uint8_t* group = bytes.data() + 10 * row + 5;
    group[2] = group[3] = 255;
    group[4] = 0xF0;
  }
  const cv::Mat image = demosaic(format, kSide, kSide, {bytes, 10}, kLinear);
  EXPECT_EQ(image.at<cv::Vec3w>(4, 4)[0], 0);
  EXPECT_EQ(image.at<cv::Vec3w>(4, 5)[1], 0);
  EXPECT_EQ(image.at<cv::Vec3w>(4, 6)[0], 65535);
  EXPECT_EQ(image.at<cv::Vec3w>(5, 5)[2], 0);
  EXPECT_EQ(image.at<cv::Vec3w>(5, 6)[1], 65535);
}

TEST(Demosaic, TakesOffTheBlackAndAppliesTheGains) {
  const BayerFormat format{BayerOrder::grbg, 12, false};
  const RawColours colours{.black_levels = {4096, 4096, 4096, 4096},
                           .red_gain = 2.0,
                           .blue_gain = 0.5,
                           .is_srgb = false};
  const int black = 255;  // of 4095, just under 4096 of 65535
  const Bytes dark = mosaic(format, "GRBG", black, black, black, 16);
  const cv::Mat night = demosaic(format, kSide, kSide, {dark, 16}, colours);
  expect_everywhere(night, 0, 0, 0);
  const int level = 256 + (4095 - 256) / 4;
  const Bytes bytes = mosaic(format, "GRBG", level, level, level, 16);
  const cv::Mat image = demosaic(format, kSide, kSide, {bytes, 16}, colours);
  const auto& colour = image.at<cv::Vec3w>(3, 3);
  EXPECT_NEAR(colour[0], 65535 / 2, 40);
  EXPECT_NEAR(colour[1], 65535 / 4, 40);
  EXPECT_NEAR(colour[2], 65535 / 8, 40);
}

TEST(Demosaic, KeepsWhiteWhite) {
  const BayerFormat format{BayerOrder::bggr, 10, false};
  const RawColours colours{
      .black_levels = {4096, 4096, 4096, 4096}, .red_gain = 1.8, .blue_gain = 1.5};
  const Bytes bytes = mosaic(format, "BGGR", 1023, 1023, 1023, 16);
  expect_everywhere(demosaic(format, kSide, kSide, {bytes, 16}, colours), 65535, 65535, 65535);
}

// IEC 61966-2-1: a linear 0.2140 is coded as 0.5, a linear 0.0021586 as 0.0278891.
TEST(Demosaic, CodesAsSrgb) {
  const BayerFormat format{BayerOrder::rggb, 16, false};
  const Bytes bytes = mosaic(format, "RGGB", 14027, 141, 65535, 16);
  const cv::Mat image = demosaic(format, kSide, kSide, {bytes, 16}, RawColours{});
  const auto& colour = image.at<cv::Vec3w>(3, 3);
  EXPECT_NEAR(colour[0], 32768, 10);
  EXPECT_NEAR(colour[1], 1822, 5);
  EXPECT_EQ(colour[2], 65535);
}

TEST(Demosaic, IgnoresDirtAboveTheValue) {
  const BayerFormat format{BayerOrder::rggb, 10, false};
  Bytes bytes = mosaic(format, "RGGB", 100, 100, 100, 16);
  for (std::size_t i = 1; i < bytes.size(); i += 2) bytes[i] |= 0xF0;
  const int expected = 100 * 65535 / 1023;
  expect_everywhere(demosaic(format, kSide, kSide, {bytes, 16}, kLinear), expected, expected,
                    expected);
}

TEST(Demosaic, RefusesWhatIsTooShort) {
  const BayerFormat packed{BayerOrder::rggb, 10, true};
  EXPECT_NO_THROW(demosaic(packed, kSide, kSide, {Bytes(10 * kSide), 10}, kLinear));
  EXPECT_THROW(demosaic(packed, kSide, kSide, {Bytes(10 * kSide - 1), 10}, kLinear), PixelError);
  EXPECT_THROW(demosaic(packed, kSide, kSide, {Bytes(10 * kSide), 9}, kLinear), PixelError);
  // Six columns of ten bits take a second group of five bytes.
  EXPECT_THROW(demosaic(packed, 6, kSide, {Bytes(8 * kSide), 8}, kLinear), PixelError);
  const BayerFormat wide{BayerOrder::rggb, 12, false};
  EXPECT_THROW(demosaic(wide, kSide, kSide, {Bytes(16 * kSide - 1), 16}, kLinear), PixelError);
  EXPECT_THROW(demosaic(wide, 7, kSide, {Bytes(200), 16}, kLinear), PixelError);
  EXPECT_THROW(demosaic(wide, 2, 2, {Bytes(200), 16}, kLinear), PixelError);
  EXPECT_THROW(demosaic({BayerOrder::rggb, 8, true}, kSide, kSide, {Bytes(200), 16}, kLinear),
               PixelError);
}

}  // namespace
}  // namespace biotomy::bridge
