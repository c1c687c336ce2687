#include "reconstruct/section/section_image.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "reconstruct/errors.hpp"
#include "tests/full_disk.hpp"
#include "tests/reconstruct/test_files.hpp"
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

TEST(SectionImage, IsReadBackToTheBit) {
  const TemporaryFolder folder;
  for (const int type : {CV_8UC3, CV_16UC3}) {
    const cv::Mat image = noise_image(type);
    for (const char* name : {"a.png", "a.tif", "b.TIFF"}) {
      write_section_image(folder.path() / name, image, {3.5, "knee", "{}"});
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

TEST(SectionImage, OfEveryFormatHasItsNotes) {
  const TemporaryFolder folder;
  for (const char* name : {"a.png", "a.tif", "a.jpg", "a.JPEG"}) {
    write_section_image(folder.path() / name, noise_image(CV_8UC3), {2.5, "knee", R"({"a":1})"});
    const std::vector<std::byte> bytes = read_file(folder.path() / name);
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    EXPECT_NE(text.find(R"({"a":1})"), std::string::npos) << name;
  }
}

TEST(SectionImage, TakesTheQualityOfAJpeg) {
  const cv::Mat image = noise_image(CV_8UC3);
  EXPECT_LT(encode_section_image(image, PictureFormat::jpeg, {}, 20).size(),
            encode_section_image(image, PictureFormat::jpeg, {}).size());
}

TEST(SectionImage, RefusesOtherExtensions) {
  const TemporaryFolder folder;
  for (const char* name : {"a.gif", "a.bmp", "a", ".png"}) {
    EXPECT_THROW(write_section_image(folder.path() / name, noise_image(CV_8UC3), {}),
                 InvalidRequest)
        << name;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(SectionImage, LeavesNothingWhereItCannotWrite) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_section_image(folder.path() / "nowhere" / "a.png", noise_image(CV_8UC3), {}),
               SampleError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(SectionImage, KeepsTheOldPictureWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  for (const char* name : {"a.png", "a.tif", "a.jpg"}) {
    const auto path = folder.path() / name;
    write_section_image(path, noise_image(CV_8UC3), {});
    const auto before = read_file(path);
    {
      const tests::FullDisk full(1000);
      EXPECT_THROW(write_section_image(path, noise_image(CV_8UC3), {}), SampleError) << name;
    }
    EXPECT_EQ(read_file(path), before) << name;
  }
  EXPECT_EQ(names_in(folder.path()).size(), 3U);
}

}  // namespace
}  // namespace biotomy::reconstruct
