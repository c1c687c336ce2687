#include "reconstruct/picture/jpeg_reader.hpp"

#include <cstdint>
#include <cstdlib>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/jpeg_library.hpp"
#include "reconstruct/picture/jpeg_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;

std::vector<std::byte> encoded(const cv::Mat& bgr, const std::vector<int>& parameters = {}) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", bgr, bytes, parameters);
  const auto* data = reinterpret_cast<const std::byte*>(bytes.data());
  return {data, data + bytes.size()};
}

std::vector<std::byte> encoded_cmyk(int width, int height) {
  JpegReport report;
  jpeg_compress_struct codec{};
  codec.err = &report.manager;
  jpeg_create_compress(&codec);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&codec, &memory, &size);
  codec.image_width = static_cast<JDIMENSION>(width);
  codec.image_height = static_cast<JDIMENSION>(height);
  codec.input_components = 4;
  codec.in_color_space = JCS_CMYK;
  jpeg_set_defaults(&codec);
  jpeg_start_compress(&codec, TRUE);
  std::vector<JSAMPLE> row(static_cast<std::size_t>(width) * 4, 100);
  JSAMPROW rows = row.data();
  while (codec.next_scanline < codec.image_height) {
    jpeg_write_scanlines(&codec, &rows, 1);
  }
  jpeg_finish_compress(&codec);
  const auto* data = reinterpret_cast<const std::byte*>(memory);
  std::vector<std::byte> file(data, data + size);
  jpeg_destroy_compress(&codec);
  std::free(memory);
  return file;
}

TEST(JpegReader, GivesThePixelsThatOpenCvGives) {
  const cv::Mat image = test_image(123, 77);
  for (const auto& parameters : {std::vector<int>{}, {cv::IMWRITE_JPEG_PROGRESSIVE, 1}}) {
    const auto file = encoded(image, parameters);
    const cv::Mat bgr = cv::imdecode(
        cv::Mat(1, static_cast<int>(file.size()), CV_8U, const_cast<std::byte*>(file.data())),
        cv::IMREAD_UNCHANGED);
    cv::Mat rgb;
    cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
    EXPECT_TRUE(same_pixels(decode_jpeg(file), rgb));
  }
}

TEST(JpegReader, MakesGreyRgb) {
  const cv::Mat image = decode_jpeg(encoded(cv::Mat(9, 9, CV_8UC1, cv::Scalar(77))));
  EXPECT_EQ(image.type(), CV_8UC3);
  EXPECT_EQ(image.at<cv::Vec3b>(4, 4), cv::Vec3b(77, 77, 77));
}

TEST(JpegReader, RefusesCmykAndSaysWhatToDo) {
  EXPECT_THAT(message_of<SampleError>([] { decode_jpeg(encoded_cmyk(20, 10)); }),
              HasSubstr("convert it to RGB"));
}

TEST(JpegReader, RefusesWhatLibjpegWouldFillIn) {
  auto file = encoded(test_image(200, 100));
  file.resize(file.size() / 2);
  file.push_back(std::byte{0xFF});
  file.push_back(std::byte{0xD9});  // an end, where half of the picture is missing
  testing::internal::CaptureStderr();
  EXPECT_THAT(message_of<SampleError>([&] { decode_jpeg(file); }), HasSubstr("is damaged: "));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(JpegReader, TakesExtraneousBytesForDamageUnlessTold) {
  const auto whole = encoded(test_image(200, 100));
  auto file = whole;
  file.insert(file.end() - 2, 100, std::byte{1});  // before the end marker
  EXPECT_THAT(message_of<SampleError>([&] { decode_jpeg(file); }), HasSubstr("extraneous"));
  EXPECT_TRUE(same_pixels(decode_jpeg(file, ExtraneousBytes::are_ignored), decode_jpeg(whole)));
}

TEST(JpegReader, TakesOtherDamageForWhatItIsAllTheSame) {
  auto file = encoded(test_image(200, 100));
  file.erase(file.begin() + static_cast<std::ptrdiff_t>(file.size() / 2), file.end() - 2);
  EXPECT_THAT(message_of<SampleError>([&] { decode_jpeg(file, ExtraneousBytes::are_ignored); }),
              HasSubstr("is damaged: "));
}

TEST(JpegReader, RefusesWhatIsNoJpeg) {
  EXPECT_THROW(decode_jpeg(std::vector<std::byte>(100, std::byte{7})), SampleError);
  EXPECT_THROW(decode_jpeg({}), SampleError);
}

}  // namespace
}  // namespace biotomy::reconstruct
