#include "firmware_bridge/camera/pixel_formats.hpp"

#include <array>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace biotomy::bridge {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr YuvCoding kFull{.matrix = YuvMatrix::bt601, .range = YuvRange::full};

cv::Mat convert(PixelFormat format, int width, int height, const Bytes& bytes, std::size_t stride,
                const YuvCoding& coding = {}) {
  const std::array planes{PixelPlane{bytes, stride}};
  return to_rgb(format, width, height, planes, coding);
}

void expect_near(const cv::Vec3b& colour, int red, int green, int blue) {
  EXPECT_NEAR(colour[0], red, 2);
  EXPECT_NEAR(colour[1], green, 2);
  EXPECT_NEAR(colour[2], blue, 2);
}

TEST(PixelFormats, TakeRgb24AsItIsAndHonourTheStride) {
  const Bytes bytes = {1, 2, 3, 4, 5, 6, 99, 99, 7, 8, 9, 10, 11, 12};
  const cv::Mat image = convert(PixelFormat::rgb24, 2, 2, bytes, 8);
  EXPECT_EQ(image.at<cv::Vec3b>(0, 1), cv::Vec3b(4, 5, 6));
  EXPECT_EQ(image.at<cv::Vec3b>(1, 0), cv::Vec3b(7, 8, 9));
}

TEST(PixelFormats, GiveAnImageThatOutlivesTheBuffer) {
  Bytes bytes = {1, 2, 3};
  const cv::Mat image = convert(PixelFormat::rgb24, 1, 1, bytes, 3);
  bytes[0] = 200;
  EXPECT_EQ(image.at<cv::Vec3b>(0, 0), cv::Vec3b(1, 2, 3));
}

TEST(PixelFormats, SwapBgr24) {
  EXPECT_EQ(convert(PixelFormat::bgr24, 1, 1, {1, 2, 3}, 3).at<cv::Vec3b>(0, 0),
            cv::Vec3b(3, 2, 1));
}

// The numbers of pure red after ITU-R BT.601: limited 81, 90, 240 and full 76, 85, 255.
TEST(PixelFormats, ConvertYuyv) {
  const Bytes limited = {81, 90, 81, 240, 235, 128, 16, 128};
  const cv::Mat image = convert(PixelFormat::yuyv, 4, 1, limited, 8);
  expect_near(image.at<cv::Vec3b>(0, 0), 255, 0, 0);
  expect_near(image.at<cv::Vec3b>(0, 2), 255, 255, 255);
  expect_near(image.at<cv::Vec3b>(0, 3), 0, 0, 0);
  const Bytes full = {76, 85, 76, 255, 255, 128, 0, 128};
  const cv::Mat full_image = convert(PixelFormat::yuyv, 4, 1, full, 8, kFull);
  expect_near(full_image.at<cv::Vec3b>(0, 1), 255, 0, 0);
  expect_near(full_image.at<cv::Vec3b>(0, 2), 255, 255, 255);
}

TEST(PixelFormats, ConvertNv12InOnePlaneOrTwo) {
  const Bytes luma = {81, 81, 0, 81, 81, 0};  // 2 × 2 with a stride of 3
  const Bytes chroma = {90, 240, 0};
  const std::array two{PixelPlane{luma, 3}, PixelPlane{chroma, 3}};
  expect_near(to_rgb(PixelFormat::nv12, 2, 2, two).at<cv::Vec3b>(1, 1), 255, 0, 0);
  const Bytes both = {81, 81, 0, 81, 81, 0, 90, 240};
  expect_near(convert(PixelFormat::nv12, 2, 2, both, 3).at<cv::Vec3b>(1, 1), 255, 0, 0);
  const Bytes full = {76, 76, 76, 76, 85, 255};
  expect_near(convert(PixelFormat::nv12, 2, 2, full, 2, kFull).at<cv::Vec3b>(0, 0), 255, 0, 0);
}

// Pure red after the other standards, limited: BT.709 63, 102, 240 and BT.2020 74, 97, 240.
TEST(PixelFormats, HonourTheColourSpace) {
  const Bytes bt709 = {63, 102, 63, 240};
  const cv::Mat image = convert(PixelFormat::yuyv, 2, 1, bt709, 4,
                                {.matrix = YuvMatrix::bt709, .range = YuvRange::limited});
  expect_near(image.at<cv::Vec3b>(0, 0), 255, 0, 0);
  const Bytes bt2020 = {74, 74, 74, 74, 97, 240};
  const cv::Mat other = convert(PixelFormat::nv12, 2, 2, bt2020, 2,
                                {.matrix = YuvMatrix::bt2020, .range = YuvRange::limited});
  expect_near(other.at<cv::Vec3b>(1, 1), 255, 0, 0);
  // In another standard these numbers are another colour.
  EXPECT_LT(convert(PixelFormat::yuyv, 2, 1, bt709, 4).at<cv::Vec3b>(0, 0)[0], 245);
}

TEST(PixelFormats, KeepGraysGrayInEveryColourSpace) {
  for (const YuvMatrix matrix : {YuvMatrix::bt601, YuvMatrix::bt709, YuvMatrix::bt2020}) {
    for (int level = 0; level < 256; level += 15) {
      const auto luma = static_cast<std::uint8_t>(level);
      const cv::Mat image = convert(PixelFormat::yuyv, 2, 1, {luma, 128, luma, 128}, 4,
                                    {.matrix = matrix, .range = YuvRange::full});
      EXPECT_EQ(image.at<cv::Vec3b>(0, 1), cv::Vec3b(luma, luma, luma));
    }
  }
}

TEST(PixelFormats, DecodeAJpegWithoutHuffmanTables) {
  // As many USB cameras send it: the tables of ITU-T T.81, annex K.3, are meant.
  Bytes file;
  ASSERT_TRUE(cv::imencode(".jpg", cv::Mat(16, 24, CV_8UC3, cv::Scalar(0, 0, 255)), file));
  for (std::size_t at = 2; at + 4 < file.size() && file[at + 1] != 0xDA;) {
    const std::size_t length = 2U + file[at + 2] * 256U + file[at + 3];
    const auto begin = file.begin() + static_cast<std::ptrdiff_t>(at);
    if (file[at + 1] == 0xC4) {
      file.erase(begin, begin + static_cast<std::ptrdiff_t>(length));
    } else {
      at += length;
    }
  }
  expect_near(convert(PixelFormat::mjpeg, 24, 16, file, 0).at<cv::Vec3b>(8, 8), 254, 0, 0);
}

TEST(PixelFormats, DecodeAJpegPaddedWithZeros) {
  const cv::Mat red(16, 24, CV_8UC3, cv::Scalar(0, 0, 255));  // OpenCV writes B, G, R
  Bytes file;
  ASSERT_TRUE(cv::imencode(".jpg", red, file));
  file.resize(file.size() + 100, 0);
  const cv::Mat image = convert(PixelFormat::mjpeg, 24, 16, file, 0);
  expect_near(image.at<cv::Vec3b>(8, 8), 254, 0, 0);
}

TEST(PixelFormats, RefuseAJpegThatWasCutOffOrHasAnotherSize) {
  Bytes file;
  ASSERT_TRUE(cv::imencode(".jpg", cv::Mat(16, 24, CV_8UC3, cv::Scalar(9, 9, 9)), file));
  EXPECT_THROW(convert(PixelFormat::mjpeg, 16, 24, file, 0), PixelError);
  file.resize(file.size() / 2);
  EXPECT_THROW(convert(PixelFormat::mjpeg, 24, 16, file, 0), PixelError);
  EXPECT_THROW(convert(PixelFormat::mjpeg, 24, 16, {}, 0), PixelError);
  EXPECT_THROW(convert(PixelFormat::mjpeg, 24, 16, {0xFF, 0xD8, 0xFF, 0xD9}, 0), PixelError);
}

TEST(PixelFormats, RefuseBuffersThatAreTooShort) {
  EXPECT_THROW(convert(PixelFormat::rgb24, 2, 2, Bytes(11), 6), PixelError);
  EXPECT_THROW(convert(PixelFormat::rgb24, 2, 2, Bytes(12), 5), PixelError);
  EXPECT_THROW(convert(PixelFormat::bgr24, 2, 2, Bytes(11), 6), PixelError);
  EXPECT_THROW(convert(PixelFormat::yuyv, 2, 2, Bytes(7), 4), PixelError);
  EXPECT_THROW(convert(PixelFormat::nv12, 2, 2, Bytes(5), 2), PixelError);
  EXPECT_THROW(convert(PixelFormat::nv12, 2, 2, Bytes(3), 2), PixelError);
  EXPECT_THROW(to_rgb(PixelFormat::rgb24, 2, 2, {}), PixelError);
  EXPECT_THROW(convert(PixelFormat::rgb24, 0, 2, Bytes(12), 6), PixelError);
}

TEST(PixelFormats, RefuseSizesThatAFormatCannotHave) {
  EXPECT_THROW(convert(PixelFormat::nv12, 3, 2, Bytes(100), 4), PixelError);
  EXPECT_THROW(convert(PixelFormat::yuyv, 3, 2, Bytes(100), 8), PixelError);
}

}  // namespace
}  // namespace biotomy::bridge
