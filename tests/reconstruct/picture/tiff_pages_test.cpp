#include "reconstruct/picture/tiff_pages.hpp"

#include <string>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>
#include <tiffio.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/tiff_image.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class TiffPages : public testing::Test {
 protected:
  void add(const cv::Mat& image, int kind = 0, const std::string& description = "") const {
    TIFF* tiff = TIFFOpen(path_.c_str(), std::filesystem::exists(path_) ? "a" : "w8");
    TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, kind);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, image.cols);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, image.rows);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, image.channels());
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC,
                 image.channels() == 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, image.rows);
    if (!description.empty()) {
      TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, description.c_str());
    }
    for (int row = 0; row < image.rows; ++row) {
      cv::Mat copy = image.row(row).clone();
      ASSERT_EQ(TIFFWriteScanline(tiff, copy.data, static_cast<std::uint32_t>(row), 0), 1);
    }
    TIFFClose(tiff);
  }
  std::string error() const {
    return message_of<SampleError>([&] { pages_of_stack(path_); });
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.tif";
};

TEST_F(TiffPages, AreReadEachByItself) {
  for (unsigned i = 0; i < 5; ++i) {
    add(test_image(20, 10, CV_8UC3, i));
  }
  const std::vector<TiffPage> pages = pages_of_stack(path_);
  ASSERT_EQ(pages.size(), 5U);
  for (const unsigned i : {4U, 0U, 2U}) {
    EXPECT_TRUE(same_pixels(read_tiff_page(path_, pages[i]), test_image(20, 10, CV_8UC3, i)));
  }
}

TEST_F(TiffPages, AreNotTheSmallCopiesAndMasks) {
  add(test_image(3, 2), FILETYPE_REDUCEDIMAGE);
  add(test_image(20, 10, CV_8UC3, 1));
  add(test_image(20, 10, CV_8UC3, 2), FILETYPE_MASK);
  add(test_image(20, 10, CV_8UC3, 3));
  const std::vector<TiffPage> pages = pages_of_stack(path_);
  ASSERT_EQ(pages.size(), 2U);
  EXPECT_TRUE(same_pixels(read_tiff_page(path_, pages[1]), test_image(20, 10, CV_8UC3, 3)));
}

TEST_F(TiffPages, OfAStackByImageJAreTaken) {
  add(test_image(20, 10), 0, "ImageJ=1.53t\nimages=2\nslices=2\nloop=false\n");
  add(test_image(20, 10));
  EXPECT_EQ(pages_of_stack(path_).size(), 2U);
}

TEST_F(TiffPages, OfAStackByImageJOfMoreThanFourGibibytesAreMissing) {
  add(test_image(20, 10), 0, "ImageJ=1.53t\nimages=500\nslices=500\nloop=false\n");
  EXPECT_THAT(error(), AllOf(HasSubstr("holds 500 images and has 1 page,"),
                             HasSubstr("save it as an image sequence")));
}

TEST_F(TiffPages, OfOneColourEachAreRefused) {
  const cv::Mat grey(10, 20, CV_8UC1, cv::Scalar(7));
  const char* const ome = R"(<OME><Image><Pixels SizeC="3" SizeT="1" SizeZ="1"/></Image></OME>)";
  for (const char* description : {"ImageJ=1.53t\nimages=3\nchannels=3\nmode=composite\n", ome}) {
    std::filesystem::remove(path_);
    add(grey, 0, description);
    add(grey);
    add(grey);
    EXPECT_THAT(error(), HasSubstr("each of its 3 colours as a page")) << description;
  }
}

TEST_F(TiffPages, OfColourWhateverOmeSaysAreTaken) {
  add(test_image(20, 10), 0, R"(<OME><Pixels SizeC="3" SizeZ="2"/></OME>)");
  add(test_image(20, 10));
  EXPECT_EQ(pages_of_stack(path_).size(), 2U);
}

TEST_F(TiffPages, OfAFileOfSmallCopiesAreNone) {
  add(test_image(3, 2), FILETYPE_REDUCEDIMAGE);
  EXPECT_THAT(error(), HasSubstr("holds no picture"));
}

TEST_F(TiffPages, ThatAreNotWhereTheyShouldBeAreDamaged) {
  add(test_image(20, 10));
  EXPECT_THAT(message_of<SampleError>([&] { read_tiff_page(path_, 1'000'000); }),
              HasSubstr("a page of it cannot be read"));
}

}  // namespace
}  // namespace biotomy::reconstruct
