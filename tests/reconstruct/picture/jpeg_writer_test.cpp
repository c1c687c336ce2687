#include "reconstruct/picture/jpeg_writer.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/image_integrity.hpp"
#include "reconstruct/picture/jpeg_reader.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The density of the JFIF header: unit, and dots along x.
std::pair<int, int> density(double pixel) {
  const std::string file = text_of(encode_jpeg(test_image(8, 8), {pixel, "", ""}, 90));
  const std::size_t place = file.find("JFIF");
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(file.at(place + i)); };
  EXPECT_EQ(byte(8) << 8 | byte(9), byte(10) << 8 | byte(11));
  return {byte(7), byte(8) << 8 | byte(9)};
}

TEST(JpegWriter, IsReadBackNearly) {
  cv::Mat image(90, 120, CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<cv::Vec3b>(y, x) =
          cv::Vec3b(static_cast<std::uint8_t>(2 * x), static_cast<std::uint8_t>(2 * y), 77);
    }
  }
  const cv::Mat back = decode_jpeg(encode_jpeg(image, {}, 95));
  ASSERT_EQ(back.size(), image.size());
  EXPECT_LE(cv::norm(back, image, cv::NORM_INF), 6.0);
}

TEST(JpegWriter, KeepsColoursAtFullResolution) {
  cv::Mat image(16, 16, CV_8UC3, cv::Scalar(0, 0, 0));
  for (int x = 0; x < 16; x += 2) {
    image.col(x).setTo(cv::Scalar(255, 0, 0));
  }
  EXPECT_LE(cv::norm(decode_jpeg(encode_jpeg(image, {}, 100)), image, cv::NORM_INF), 8.0);
}

TEST(JpegWriter, CutsSixteenBitsToEight) {
  const cv::Mat image(8, 8, CV_16UC3, cv::Scalar(257 * 200, 257 * 100, 257 * 20));
  const cv::Vec3b pixel = decode_jpeg(encode_jpeg(image, {}, 95)).at<cv::Vec3b>(3, 3);
  EXPECT_LE(cv::norm(pixel, cv::Vec3b(200, 100, 20), cv::NORM_INF), 3.0);
}

TEST(JpegWriter, SaysTheDensityInTheUnitThatIsNearer) {
  EXPECT_EQ(density(10.0), (std::pair{2, 1000}));   // dots per centimetre, exactly
  EXPECT_EQ(density(254.0), (std::pair{1, 100}));   // dots per inch, exactly
  EXPECT_EQ(density(12'700.0), (std::pair{1, 2}));  // less than one a centimetre
}

TEST(JpegWriter, SaysNoDensityThatWouldNotBeTrue) {
  for (const double pixel : {0.0, 0.01, 7'000.0, 1e6}) {
    EXPECT_EQ(density(pixel), (std::pair{0, 1})) << pixel;
  }
}

TEST(JpegWriter, KeepsTheDescriptionAsAComment) {
  const std::string file = text_of(encode_jpeg(test_image(8, 8), {1.0, "", R"({"a":1})"}, 90));
  EXPECT_THAT(file, HasSubstr(std::string("\xFF\xFE\0\x09{\"a\":1}", 11)));
}

TEST(JpegWriter, QualityCostsBytes) {
  const cv::Mat image = test_image(200, 200);
  EXPECT_LT(encode_jpeg(image, {}, 30).size(), encode_jpeg(image, {}, 90).size());
  EXPECT_THROW(encode_jpeg(image, {}, 0), InvalidRequest);
  EXPECT_THROW(encode_jpeg(image, {}, 101), InvalidRequest);
}

TEST(JpegWriter, RefusesWhatTheFormatCannotHold) {
  EXPECT_THAT(message_of<SampleError>(
                  [] { encode_jpeg(cv::Mat(1, 65'501, CV_8UC3, cv::Scalar()), {}, 90); }),
              HasSubstr("65500"));
  EXPECT_THROW(encode_jpeg(test_image(8, 8), {1.0, "", std::string(70'000, 'x')}, 90), SampleError);
  EXPECT_EQ(jpeg_damage(encode_jpeg(cv::Mat(1, 65'500, CV_8UC3, cv::Scalar()), {}, 90)),
            std::nullopt);
}

}  // namespace
}  // namespace biotomy::reconstruct
