#include "reconstruct/picture/rgb_picture.hpp"

#include <functional>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/jpeg_writer.hpp"
#include "reconstruct/picture/png_writer.hpp"
#include "reconstruct/picture/tiff_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;

const std::map<std::string, std::function<void(const cv::Mat&)>> kWriters = {
    {"PNG", [](const cv::Mat& picture) { encode_png(picture, {}); }},
    {"TIFF", [](const cv::Mat& picture) { encode_tiff(picture, {}); }},
    {"JPEG", [](const cv::Mat& picture) { encode_jpeg(picture, {}, kDefaultJpegQuality); }},
};

TEST(RgbPicture, IsOf8Or16BitsAndAnySize) {
  for (const int type : {CV_8UC3, CV_16UC3}) {
    EXPECT_NO_THROW(require_rgb_picture(test_image(1, 1, type)));
    EXPECT_NO_THROW(require_rgb_picture(test_image(30, 20, type).colRange(3, 9)));
  }
}

TEST(RgbPicture, OfAnotherTypeIsRefusedByEveryWriter) {
  for (const auto& [name, write] : kWriters) {
    for (const int type : {CV_8UC1, CV_8UC4, CV_16UC1, CV_32FC3, CV_8SC3}) {
      EXPECT_THAT(message_of<InvalidRequest>([&] { write(cv::Mat(4, 5, type, cv::Scalar())); }),
                  HasSubstr(cv::typeToString(type)))
          << name;
    }
  }
}

TEST(RgbPicture, WithoutPixelsIsRefusedByEveryWriter) {
  for (const auto& [name, write] : kWriters) {
    for (const cv::Mat& picture : {cv::Mat(), cv::Mat(0, 5, CV_8UC3), cv::Mat(5, 0, CV_16UC3)}) {
      EXPECT_THAT(message_of<InvalidRequest>([&] { write(picture); }), HasSubstr("no pixels"))
          << name;
    }
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
