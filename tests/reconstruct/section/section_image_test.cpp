#include "reconstruct/section/section_image.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <tiffio.h>

#include "reconstruct/errors.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::TemporaryFolder;

cv::Mat noise_image(int type) {
  cv::Mat image(37, 53, type);
  cv::RNG random(1);
  random.fill(image, cv::RNG::UNIFORM, 0, CV_MAT_DEPTH(type) == CV_8U ? 256 : 65536);
  return image;
}

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = value << 8U | static_cast<std::uint8_t>(bytes.at(at + i));
  }
  return value;
}

TEST(SectionImage, IsReadBackToTheBit) {
  const TemporaryFolder folder;
  for (const int type : {CV_8UC3, CV_16UC3}) {
    const cv::Mat image = noise_image(type);
    for (const char* name : {"a.png", "a.tif", "b.TIFF"}) {
      write_section_image(folder.path() / name, image, 3.5);
      cv::Mat read = cv::imread((folder.path() / name).string(), cv::IMREAD_UNCHANGED);
      ASSERT_EQ(read.type(), type);
      cv::Mat swapped;
      cv::mixChannels(std::vector<cv::Mat>{read},
                      std::vector<cv::Mat>{swapped = cv::Mat(read.size(), type)},
                      {0, 2, 1, 1, 2, 0});
      EXPECT_EQ(cv::norm(swapped, image, cv::NORM_INF), 0.0) << name;
    }
  }
}

TEST(SectionImage, SaysThePixelSizeInPng) {
  const TemporaryFolder folder;
  write_section_image(folder.path() / "a.png", noise_image(CV_8UC3), 2.5);
  const std::string bytes = contents(folder.path() / "a.png");
  const std::size_t place = bytes.find("pHYs");
  ASSERT_NE(place, std::string::npos);
  EXPECT_EQ(big_endian(bytes, place + 4), 400'000U);
  EXPECT_EQ(big_endian(bytes, place + 8), 400'000U);
  EXPECT_EQ(bytes.at(place + 12), 1);
}

TEST(SectionImage, SaysThePixelSizeInTiff) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.tif";
  write_section_image(path, noise_image(CV_8UC3), 2.5);
  TIFF* tiff = TIFFOpen(path.c_str(), "r");
  ASSERT_NE(tiff, nullptr);
  float resolution = 0.0F;
  std::uint16_t unit = 0;
  EXPECT_EQ(TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &resolution), 1);
  EXPECT_EQ(TIFFGetField(tiff, TIFFTAG_RESOLUTIONUNIT, &unit), 1);
  TIFFClose(tiff);
  EXPECT_FLOAT_EQ(resolution, 4000.0F);
  EXPECT_EQ(unit, RESUNIT_CENTIMETER);
}

TEST(SectionImage, RefusesOtherExtensions) {
  const TemporaryFolder folder;
  for (const char* name : {"a.jpg", "a.bmp", "a", ".png"}) {
    EXPECT_THROW(write_section_image(folder.path() / name, noise_image(CV_8UC3), 1.0),
                 InvalidRequest)
        << name;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(SectionImage, LeavesNothingWhereItCannotWrite) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_section_image(folder.path() / "nowhere" / "a.png", noise_image(CV_8UC3), 1.0),
               SampleError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace biotomy::reconstruct
