#include "reconstruct/picture/inflated_png.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <libdeflate.h>
#include <opencv2/imgcodecs.hpp>

#include "reconstruct/picture/png_chunk.hpp"
#include "tests/reconstruct/test_images.hpp"

namespace biotomy::reconstruct {
namespace {

using Bytes = std::vector<std::byte>;

Bytes png_of(const cv::Mat& image) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes);
  const auto* data = reinterpret_cast<const std::byte*>(bytes.data());
  return {data, data + bytes.size()};
}

Bytes joined(const InflatedPng& png) {
  Bytes file;
  for (const auto& part : png.parts()) {
    file.insert(file.end(), part.begin(), part.end());
  }
  return file;
}

/// Where the chunk of this type begins, the first one.
std::size_t place_of(const Bytes& file, const std::string& type) {
  std::size_t position = kPngSignature.size();
  while (const auto chunk = png_chunk_at(file, position)) {
    if (chunk->is(type)) {
      return position;
    }
    position += chunk->whole.size();
  }
  ADD_FAILURE() << "no " << type;
  return 0;
}

std::size_t count_of(const Bytes& file, const std::string& type) {
  std::size_t count = 0;
  std::size_t position = kPngSignature.size();
  while (const auto chunk = png_chunk_at(file, position)) {
    count += chunk->is(type) ? 1 : 0;
    position += chunk->whole.size();
  }
  return count;
}

TEST(InflatedPng, IsAFileOfStoredBlocksInOneChunk) {
  const cv::Mat image = test_image(300, 200, CV_8UC3);
  const Bytes before = png_of(image);
  ASSERT_GT(count_of(before, "IDAT"), 1U) << "must be joined";
  const auto png = InflatedPng::of(before);
  ASSERT_TRUE(png);
  const Bytes file = joined(*png);
  EXPECT_EQ(count_of(file, "IDAT"), 1U);
  const auto pixels = png_chunk_at(file, place_of(file, "IDAT"));
  ASSERT_TRUE(pixels);
  const std::size_t filtered = 200 * (1 + 300 * 3);
  EXPECT_EQ(pixels->data().size(), 2 + 3 * 5 + filtered + 4) << "blocks of up to 65535 bytes";
  EXPECT_EQ(count_of(file, "IEND"), 1U);
}

// zlib checks the sum of the stream here, as the reader of this project does not.
TEST(InflatedPng, IsReadByOthersToo) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3}) {
    cv::Mat image(50, 70, type);
    cv::randu(image, 0, 256);
    const Bytes before = png_of(image);
    const auto png = InflatedPng::of(before);
    ASSERT_TRUE(png);
    Bytes file = joined(*png);
    const auto place = place_of(file, "IDAT");
    const auto pixels = png_chunk_at(file, place);
    const std::uint32_t crc =
        libdeflate_crc32(0, pixels->covered().data(), pixels->covered().size());
    for (std::size_t i = 0; i < 4; ++i) {
      file[place + pixels->whole.size() - 1 - i] = std::byte(crc >> 8 * i & 0xFF);
    }
    const cv::Mat read = cv::imdecode(
        cv::Mat(1, static_cast<int>(file.size()), CV_8UC1, file.data()), cv::IMREAD_UNCHANGED);
    EXPECT_TRUE(same_pixels(read, image)) << type;
  }
}

TEST(InflatedPng, LeavesToLibpngWhatIsNotWhole) {
  const Bytes whole = png_of(test_image(300, 200, CV_8UC3));
  ASSERT_TRUE(InflatedPng::of(whole));
  EXPECT_FALSE(InflatedPng::of({}));
  for (std::size_t size = 0; size < whole.size() - 12; size += 97) {
    EXPECT_FALSE(InflatedPng::of(std::span(whole).first(size))) << size;
  }
  Bytes no_signature = whole;
  no_signature[0] = std::byte{0};
  EXPECT_FALSE(InflatedPng::of(no_signature));
}

TEST(InflatedPng, LeavesToLibpngAHeaderThatDoesNotFitThePixels) {
  const Bytes whole = png_of(test_image(300, 200, CV_8UC3));
  const std::size_t header = kPngSignature.size() + 8;
  for (const auto& [place, value] : std::vector<std::pair<std::size_t, int>>{
           {3, 44 + 1}, {7, 201}, {7, 199}, {8, 16}, {8, 99}, {9, 6}, {9, 1}, {9, 200}, {12, 1}}) {
    Bytes file = whole;
    file[header + place] = std::byte(value);
    EXPECT_FALSE(InflatedPng::of(file)) << place << " " << value;
  }
}

// Memory is not asked for: a sanitizer's or a container's limit would end the program.
TEST(InflatedPng, LeavesToLibpngAHeaderThatNoStreamOfThisLengthCanFill) {
  Bytes file = png_of(cv::Mat(8, 8, CV_8UC3, cv::Scalar(1, 2, 3)));
  const std::size_t header = kPngSignature.size() + 8;
  file[header + 2] = std::byte{0x40};  // a width of 16392
  file[header + 6] = std::byte{0x40};
  EXPECT_FALSE(InflatedPng::of(file));
  file[header + 0] = std::byte{0xFF};
  file[header + 4] = std::byte{0xFF};
  EXPECT_FALSE(InflatedPng::of(file));
}

TEST(InflatedPng, LeavesToLibpngAStreamThatIsDamaged) {
  Bytes file = png_of(test_image(300, 200, CV_8UC3));
  const std::size_t place = place_of(file, "IDAT");
  for (const std::size_t at : {8, 9, 40, 4000}) {
    Bytes damaged = file;
    damaged[place + at] ^= std::byte{0x55};
    EXPECT_FALSE(InflatedPng::of(damaged)) << at;
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
