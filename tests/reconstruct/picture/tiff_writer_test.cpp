#include "reconstruct/picture/tiff_writer.hpp"

#include <cstdint>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <tiffio.h>

#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

class TiffWriter : public testing::Test {
 protected:
  /// Written, and opened by libtiff.
  TIFF* open(const cv::Mat& image, const PictureNotes& notes) {
    write_file(path_, encode_tiff(image, notes));
    tiff_.reset(TIFFOpen(path_.c_str(), "r"));
    return tiff_.get();
  }

  std::string text(std::uint32_t tag) const {
    const char* words = nullptr;
    return TIFFGetField(tiff_.get(), tag, &words) == 1 ? words : "";
  }

  struct Close {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
  };
  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.tif";
  std::unique_ptr<TIFF, Close> tiff_;
};

TEST_F(TiffWriter, IsReadBackToTheBitByOpenCv) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(5, 3), cv::Size(500, 700)}) {
    for (const int type : {CV_8UC3, CV_16UC3}) {
      const cv::Mat image = test_image(size.width, size.height, type);
      write_file(path_, encode_tiff(image, {}));
      const cv::Mat bgr = cv::imread(path_.string(), cv::IMREAD_UNCHANGED);
      ASSERT_EQ(bgr.type(), type);
      cv::Mat rgb;
      cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
      EXPECT_TRUE(same_pixels(rgb, image)) << size;
    }
  }
}

TEST_F(TiffWriter, SaysThePixelSizeToTheFraction) {
  TIFF* tiff = open(test_image(20, 10), {3.0, "", ""});
  ASSERT_NE(tiff, nullptr);
  float resolution = 0.0F;
  std::uint16_t unit = 0;
  EXPECT_EQ(TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &resolution), 1);
  EXPECT_FLOAT_EQ(resolution, 10'000.0F / 3.0F);
  EXPECT_EQ(TIFFGetField(tiff, TIFFTAG_YRESOLUTION, &resolution), 1);
  EXPECT_FLOAT_EQ(resolution, 10'000.0F / 3.0F);
  EXPECT_EQ(TIFFGetField(tiff, TIFFTAG_RESOLUTIONUNIT, &unit), 1);
  EXPECT_EQ(unit, RESUNIT_CENTIMETER);
}

TEST_F(TiffWriter, KeepsNameAndDescription) {
  ASSERT_NE(open(test_image(20, 10), {3.0, "knee", R"({"a":1})"}), nullptr);
  EXPECT_EQ(text(TIFFTAG_DOCUMENTNAME), "knee");
  EXPECT_EQ(text(TIFFTAG_IMAGEDESCRIPTION), R"({"a":1})");
  EXPECT_EQ(text(TIFFTAG_SOFTWARE), "Biotomy " BIOTOMY_VERSION);
}

TEST_F(TiffWriter, SaysNothingOfASizeThatItWasNotTold) {
  TIFF* tiff = open(test_image(20, 10), {});
  float resolution = 0.0F;
  EXPECT_EQ(TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &resolution), 0);
  EXPECT_EQ(text(TIFFTAG_IMAGEDESCRIPTION), "");
}

}  // namespace
}  // namespace biotomy::reconstruct
