#include "reconstruct/picture/png_reader.hpp"

#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <libdeflate.h>
#include <png.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/png_chunk.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;

std::vector<std::byte> encoded(const cv::Mat& bgr) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", bgr, bytes);
  const auto* data = reinterpret_cast<const std::byte*>(bytes.data());
  return {data, data + bytes.size()};
}

/// Any kind of PNG there is, by libpng. `rows` are packed as PNG packs them.
struct AnyPng {
  int width = 0;
  int bits = 8;
  int colour_type = PNG_COLOR_TYPE_RGB;
  bool interlaced = false;
  std::vector<png_color> palette{};
  std::vector<png_byte> transparency{};
  std::vector<std::vector<png_byte>> rows{};

  std::vector<std::byte> write() {
    std::vector<std::byte> file;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    const auto append = [](png_structp writer, png_bytep bytes, png_size_t size) {
      auto& out = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(writer));
      const auto* data = reinterpret_cast<const std::byte*>(bytes);
      out.insert(out.end(), data, data + size);
    };
    png_set_write_fn(png, &file, append, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(rows.size()),
                 bits, colour_type, interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    if (!palette.empty()) {
      png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
    }
    if (!transparency.empty()) {
      png_set_tRNS(png, info, transparency.data(), static_cast<int>(transparency.size()), nullptr);
    }
    png_write_info(png, info);
    std::vector<png_bytep> pointers;
    for (auto& row : rows) {
      pointers.push_back(row.data());
    }
    png_write_image(png, pointers.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return file;
  }
};

TEST(PngReader, GivesBackColoursToTheBit) {
  for (const int type : {CV_8UC3, CV_16UC3}) {
    const cv::Mat rgb = test_image(71, 43, type);
    cv::Mat bgr;
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
    EXPECT_TRUE(same_pixels(decode_png(encoded(bgr)), rgb));
  }
}

/// The CRC of the chunk that begins at `place` as its data now are.
void mend_crc(std::vector<std::byte>& file, std::size_t place) {
  const PngChunk chunk = png_chunk_at(file, place).value();
  const std::uint32_t crc = libdeflate_crc32(0, chunk.covered().data(), chunk.covered().size());
  for (std::size_t i = 0; i < 4; ++i) {
    file[place + chunk.whole.size() - 1 - i] = std::byte(crc >> 8 * i & 0xFF);
  }
}

// The chunks' CRCs are right: only the sum of the pixels themselves tells.
TEST(PngReader, RefusesPixelsWhoseSumIsWrong) {
  std::vector<std::byte> file = encoded(test_image(20, 10, CV_8UC3));
  std::size_t place = kPngSignature.size();
  while (!png_chunk_at(file, place).value().is("IDAT")) {
    place += png_chunk_at(file, place)->whole.size();
  }
  const std::size_t end_of_data = place + png_chunk_at(file, place)->whole.size() - 4;
  file[end_of_data - 1] ^= std::byte{1};
  mend_crc(file, place);
  EXPECT_THAT(message_of<SampleError>([&] { decode_png(file); }), HasSubstr("cannot be decoded"));
}

TEST(PngReader, MakesGreyRgb) {
  const cv::Mat image = decode_png(encoded(cv::Mat(5, 7, CV_16UC1, cv::Scalar(0x1234))));
  EXPECT_EQ(image.type(), CV_16UC3);
  EXPECT_EQ(image.at<cv::Vec3w>(4, 6), cv::Vec3w(0x1234, 0x1234, 0x1234));
}

TEST(PngReader, DropsTransparencyAndKeepsTheColours) {
  EXPECT_EQ(
      decode_png(encoded(cv::Mat(5, 5, CV_8UC4, cv::Scalar(30, 20, 10, 0)))).at<cv::Vec3b>(2, 2),
      cv::Vec3b(10, 20, 30));
  AnyPng grey_alpha{1, 8, PNG_COLOR_TYPE_GRAY_ALPHA};
  grey_alpha.rows = {{77, 0}};
  EXPECT_EQ(decode_png(grey_alpha.write()).at<cv::Vec3b>(0, 0), cv::Vec3b(77, 77, 77));
  AnyPng deep{1, 16, PNG_COLOR_TYPE_RGB_ALPHA};
  deep.rows = {{1, 2, 3, 4, 5, 6, 0, 0}};
  EXPECT_EQ(decode_png(deep.write()).at<cv::Vec3w>(0, 0), cv::Vec3w(0x0102, 0x0304, 0x0506));
}

TEST(PngReader, ResolvesPalettesOfEveryDepth) {
  for (const int bits : {1, 2, 4, 8}) {
    AnyPng picture{2, bits, PNG_COLOR_TYPE_PALETTE};
    picture.palette = {{10, 20, 30}, {40, 50, 60}};
    picture.transparency = {0, 255};
    picture.rows = {bits == 8 ? std::vector<png_byte>{1, 0}
                              : std::vector<png_byte>{static_cast<png_byte>(1U << (8 - bits))}};
    const cv::Mat image = decode_png(picture.write());
    EXPECT_EQ(image.at<cv::Vec3b>(0, 0), cv::Vec3b(40, 50, 60)) << bits;
    EXPECT_EQ(image.at<cv::Vec3b>(0, 1), cv::Vec3b(10, 20, 30)) << bits;
  }
}

TEST(PngReader, SpreadsFewBitsOverEight) {
  AnyPng picture{4, 2, PNG_COLOR_TYPE_GRAY};
  picture.rows = {{0b00011011}};
  const cv::Mat image = decode_png(picture.write());
  for (int x = 0; x < 4; ++x) {
    EXPECT_EQ(image.at<cv::Vec3b>(0, x)[0], 85 * x);
  }
}

TEST(PngReader, ReadsInterlacedFiles) {
  AnyPng picture{9, 8, PNG_COLOR_TYPE_GRAY, true};
  for (int y = 0; y < 9; ++y) {
    picture.rows.emplace_back();
    for (int x = 0; x < 9; ++x) {
      picture.rows.back().push_back(static_cast<png_byte>(10 * y + x));
    }
  }
  const cv::Mat image = decode_png(picture.write());
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 9; ++x) {
      EXPECT_EQ(image.at<cv::Vec3b>(y, x)[1], 10 * y + x);
    }
  }
}

TEST(PngReader, RefusesWhatEndsEarly) {
  auto file = encoded(test_image(40, 30));
  file.resize(file.size() / 2);
  EXPECT_THAT(message_of<SampleError>([&] { decode_png(file); }), HasSubstr("truncated"));
}

TEST(PngReader, RefusesNonsenseBeforeItAsksForMemory) {
  auto file = encoded(test_image(4, 3));
  for (std::size_t i = 16; i < 24; ++i) {
    file[i] = std::byte{0x7F};  // width and height
  }
  EXPECT_THROW(decode_png(file), SampleError);
}

}  // namespace
}  // namespace biotomy::reconstruct
