#include "reconstruct/picture/image_integrity.hpp"

#include <gtest/gtest.h>

#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"

namespace biotomy::reconstruct {
namespace {

std::vector<std::byte> encoded(const std::string& extension,
                               const std::vector<int>& parameters = {}) {
  std::vector<unsigned char> bytes;
  cv::imencode(extension, test_image(90, 70), bytes, parameters);
  const auto* data = reinterpret_cast<const std::byte*>(bytes.data());
  return {data, data + bytes.size()};
}

TEST(PngDamage, NoneInAGoodFile) {
  EXPECT_EQ(png_damage(encoded(".png")), std::nullopt);
}

TEST(PngDamage, FoundInAFileCutOffAnywhere) {
  const auto file = encoded(".png");
  for (std::size_t length = 0; length < file.size(); ++length) {
    ASSERT_TRUE(png_damage({file.data(), length})) << length;
  }
}

TEST(PngDamage, FoundWhereverAByteChanged) {
  const auto file = encoded(".png");
  for (std::size_t place = 0; place < file.size(); ++place) {
    auto damaged = file;
    damaged[place] ^= std::byte{0x10};
    ASSERT_TRUE(png_damage(damaged)) << place;
  }
}

TEST(JpegDamage, NoneInAGoodFile) {
  EXPECT_EQ(jpeg_damage(encoded(".jpg")), std::nullopt);
  EXPECT_EQ(jpeg_damage(encoded(".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1})), std::nullopt);
  EXPECT_EQ(jpeg_damage(encoded(".jpg", {cv::IMWRITE_JPEG_RST_INTERVAL, 2})), std::nullopt);
}

TEST(JpegDamage, FoundInAFileCutOffAnywhere) {
  for (const int progressive : {0, 1}) {
    const auto file = encoded(".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, progressive});
    for (std::size_t length = 0; length < file.size(); ++length) {
      ASSERT_TRUE(jpeg_damage({file.data(), length})) << length;
    }
  }
}

TEST(JpegDamage, FoundInAFileOfAnotherKind) {
  EXPECT_TRUE(jpeg_damage(encoded(".png")));
}

}  // namespace
}  // namespace biotomy::reconstruct
