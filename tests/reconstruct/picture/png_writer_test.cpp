#include "reconstruct/picture/png_writer.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <oneapi/tbb/global_control.h>
#include <opencv2/core.hpp>

#include "reconstruct/picture/image_integrity.hpp"
#include "reconstruct/picture/png_reader.hpp"
#include "tests/reconstruct/test_images.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint32_t number_at(const std::string& bytes, std::size_t place) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = value << 8U | static_cast<std::uint8_t>(bytes.at(place + i));
  }
  return value;
}

cv::Mat noise_image(cv::Size size, int type) {
  cv::Mat image(size, type);
  cv::RNG random(1);
  random.fill(image, cv::RNG::UNIFORM, 0, CV_MAT_DEPTH(type) == CV_8U ? 256 : 65536);
  return image;
}

TEST(PngWriter, IsReadBackToTheBitByOpenCv) {
  // One pixel; narrower than a vector; several strips, the last one shorter.
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(5, 3), cv::Size(700, 1100)}) {
    for (const int type : {CV_8UC3, CV_16UC3}) {
      for (const cv::Mat& image :
           {noise_image(size, type), test_image(size.width, size.height, type),
            cv::Mat(size, type, cv::Scalar(12, 34, 56))}) {
        const auto file = encode_png(image, {});
        const cv::Mat bgr = cv::imdecode(
            cv::Mat(1, static_cast<int>(file.size()), CV_8U, const_cast<std::byte*>(file.data())),
            cv::IMREAD_UNCHANGED);
        ASSERT_EQ(bgr.type(), type);
        cv::Mat rgb;
        cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
        EXPECT_TRUE(same_pixels(rgb, image)) << size;
      }
    }
  }
}

TEST(PngWriter, TakesAPartOfALargerImage) {
  const cv::Mat image = test_image(80, 60);
  const cv::Mat part = image(cv::Rect(7, 11, 30, 20));
  EXPECT_TRUE(same_pixels(decode_png(encode_png(part, {})), part));
}

TEST(PngWriter, MakesFilesWithoutDamage) {
  EXPECT_EQ(png_damage(encode_png(test_image(700, 1100), {1.0, "name", "{}"})), std::nullopt);
}

TEST(PngWriter, DoesNotDependOnTheNumberOfThreads) {
  const cv::Mat image = test_image(700, 1100);
  const auto many = encode_png(image, {});
  const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(encode_png(image, {}), many);
}

TEST(PngWriter, SaysThePixelSize) {
  const std::string file = text_of(encode_png(test_image(4, 4), {2.5, "", ""}));
  const std::size_t place = file.find("pHYs");
  ASSERT_NE(place, std::string::npos);
  EXPECT_EQ(number_at(file, place + 4), 400'000U);
  EXPECT_EQ(number_at(file, place + 8), 400'000U);
  EXPECT_EQ(file.at(place + 12), 1);  // a metre
  EXPECT_LT(place, file.find("IDAT"));
}

TEST(PngWriter, LeavesUnsaidWhatTheFormatCannotSay) {
  for (const double pixel : {0.0, 1e-5, 1e7}) {
    EXPECT_THAT(text_of(encode_png(test_image(4, 4), {pixel, "", ""})), Not(HasSubstr("pHYs")));
  }
}

TEST(PngWriter, KeepsNameAndDescription) {
  const std::string file = text_of(encode_png(test_image(4, 4), {1.0, "Knie Ä", R"({"a":1})"}));
  EXPECT_THAT(file, HasSubstr(std::string("iTXtTitle\0\0\0\0\0Knie Ä", 21)));
  EXPECT_THAT(file, HasSubstr(std::string("iTXtDescription\0\0\0\0\0{\"a\":1}", 27)));
  EXPECT_THAT(file, HasSubstr(std::string("iTXtSoftware\0\0\0\0\0Biotomy ", 25)));
}

}  // namespace
}  // namespace biotomy::reconstruct
