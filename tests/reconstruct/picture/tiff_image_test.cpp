#include "reconstruct/picture/tiff_image.hpp"

#include <chrono>

#include <gmock/gmock.h>
#include <tiffio.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::TemporaryFolder;

/// A TIFF in strips as other programs write them. `samples` holds its rows, planes one after the
/// other if it is planar.
struct TiffKnobs {
  int photometric = PHOTOMETRIC_RGB;
  int planar = PLANARCONFIG_CONTIG;
  int bits = 8;
  int samples_per_pixel = 3;
  int compression = COMPRESSION_LZW;
  const char* mode = "w";  ///< "a" adds a page
  int subfile = 0;
};

void write_strips(const std::filesystem::path& path, const cv::Mat& rows, int width, int height,
                  const TiffKnobs& knobs) {
  TIFF* tiff = TIFFOpen(path.c_str(), knobs.mode);
  TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, knobs.subfile);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, knobs.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, knobs.samples_per_pixel);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, knobs.photometric);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, knobs.planar);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, knobs.compression);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 7);
  for (int row = 0; row < rows.rows; ++row) {
    cv::Mat copy = rows.row(row).clone();  // libtiff may work in place
    ASSERT_EQ(TIFFWriteScanline(tiff, copy.data, static_cast<std::uint32_t>(row % height),
                                static_cast<std::uint16_t>(row / height)),
              1);
  }
  TIFFClose(tiff);
}

/// Pages of one pixel and of one kind, of which libtiff itself takes long to write
/// many.
void write_pages(const std::filesystem::path& path, std::uint32_t pages, std::uint16_t kind) {
  constexpr std::uint32_t kHeader = 8;
  constexpr std::uint32_t kPage = 2 + 5 * 12 + 4;
  std::vector<std::byte> file;
  const auto add = [&](auto number) {
    for (std::size_t i = 0; i < sizeof(number); ++i) {
      file.push_back(static_cast<std::byte>(number >> (8 * i)));
    }
  };
  const auto add_tag = [&](std::uint16_t tag, std::uint32_t value) {
    add(tag);
    add(std::uint16_t{TIFF_LONG});
    add(std::uint32_t{1});
    add(value);
  };
  add(std::uint32_t{0x002A4949});
  add(kHeader);
  for (std::uint32_t page = 1; page <= pages; ++page) {
    add(std::uint16_t{5});
    add_tag(TIFFTAG_SUBFILETYPE, kind);
    add_tag(TIFFTAG_IMAGEWIDTH, 1);
    add_tag(TIFFTAG_IMAGELENGTH, 1);
    add_tag(TIFFTAG_STRIPOFFSETS, kHeader);
    add_tag(TIFFTAG_STRIPBYTECOUNTS, 1);
    add(page < pages ? kHeader + page * kPage : 0);
  }
  write_file(path, file);
}

class TiffImage : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "a.tif";
};

TEST_F(TiffImage, InStripsIsReadWhole) {
  for (const int type : {CV_8UC3, CV_16UC3}) {
    const cv::Mat image = test_image(33, 50, type);
    write_strips(path_, image, 33, 50, {.bits = type == CV_8UC3 ? 8 : 16});
    EXPECT_TRUE(same_pixels(read_tiff_image(path_), image));
  }
}

TEST_F(TiffImage, InPlanesIsReadWhole) {
  const cv::Mat image = test_image(33, 50);
  std::vector<cv::Mat> planes;
  cv::split(image, planes);
  cv::Mat rows;
  cv::vconcat(planes, rows);
  write_strips(path_, rows, 33, 50, {.planar = PLANARCONFIG_SEPARATE});
  EXPECT_TRUE(same_pixels(read_tiff_image(path_), image));
}

TEST_F(TiffImage, InTilesIsReadWhole) {
  const cv::Mat image = test_image(300, 270, CV_16UC3);
  write_layer_image(path_, image, {1, {1, 1, 1}}, {});
  EXPECT_TRUE(same_pixels(read_tiff_image(path_), image));
}

TEST_F(TiffImage, WhiteIsZeroIsTurnedRound) {
  write_strips(path_, cv::Mat(4, 4, CV_8UC1, cv::Scalar(10)), 4, 4,
               {.photometric = PHOTOMETRIC_MINISWHITE, .samples_per_pixel = 1});
  EXPECT_EQ(read_tiff_image(path_).at<cv::Vec3b>(1, 1), cv::Vec3b(245, 245, 245));
}

TEST_F(TiffImage, FurtherChannelsAreDropped) {
  write_strips(path_, cv::Mat(4, 4, CV_8UC4, cv::Scalar(1, 2, 3, 0)), 4, 4,
               {.samples_per_pixel = 4});
  EXPECT_EQ(read_tiff_image(path_).at<cv::Vec3b>(1, 1), cv::Vec3b(1, 2, 3));
}

TEST_F(TiffImage, IsReadPastItsSmallCopies) {
  const cv::Mat image = test_image(33, 50);
  write_strips(path_, test_image(3, 5), 3, 5, {.subfile = FILETYPE_REDUCEDIMAGE});
  write_strips(path_, image, 33, 50, {.mode = "a"});
  EXPECT_TRUE(same_pixels(read_tiff_image(path_), image));
}

TEST_F(TiffImage, RefusesAStackInOneFile) {
  write_strips(path_, test_image(3, 5), 3, 5, {});
  write_strips(path_, test_image(3, 5), 3, 5, {.mode = "a"});
  EXPECT_THAT(message_of<SampleError>([&] { read_tiff_image(path_); }),
              testing::AllOf(testing::HasSubstr("holds more than one picture"),
                             testing::HasSubstr("split it into files")));
}

TEST_F(TiffImage, RefusesAFileOfSmallCopiesOnly) {
  write_strips(path_, test_image(3, 5), 3, 5, {.subfile = FILETYPE_REDUCEDIMAGE});
  EXPECT_THAT(message_of<SampleError>([&] { read_tiff_image(path_); }),
              testing::HasSubstr("holds no picture"));
}

TEST_F(TiffImage, IsRefusedSoonHoweverManyPagesItHas) {
  using std::chrono::steady_clock;
  const auto start = steady_clock::now();
  for (const std::uint16_t kind : {0, int{FILETYPE_REDUCEDIMAGE}}) {
    write_pages(path_, 20'000, kind);
    EXPECT_THAT(message_of<SampleError>([&] { read_tiff_image(path_); }),
                testing::HasSubstr(kind == 0 ? "holds more than one" : "holds no picture"));
  }
  EXPECT_LT(steady_clock::now() - start, std::chrono::seconds(10));  // once it was minutes
}

TEST_F(TiffImage, RefusesColoursThatAreCalledGrey) {
  write_strips(path_, test_image(4, 4), 4, 4, {.photometric = PHOTOMETRIC_MINISBLACK});
  EXPECT_THAT(message_of<SampleError>([&] { read_tiff_image(path_); }),
              testing::HasSubstr("says that they are grey"));
}

TEST_F(TiffImage, RefusesBitsAndColoursThatItWouldGetWrong) {
  write_strips(path_, cv::Mat(4, 4, CV_32SC1, cv::Scalar(1)), 4, 4,
               {.photometric = PHOTOMETRIC_MINISBLACK, .bits = 32, .samples_per_pixel = 1});
  EXPECT_THAT(message_of<SampleError>([&] { read_tiff_image(path_); }),
              testing::HasSubstr("32 bits"));
  write_strips(path_, cv::Mat(4, 4, CV_8UC4, cv::Scalar(1)), 4, 4,
               {.photometric = PHOTOMETRIC_SEPARATED, .samples_per_pixel = 4});
  EXPECT_THAT(message_of<SampleError>([&] { read_tiff_image(path_); }),
              testing::HasSubstr("neither grey nor RGB"));
}

}  // namespace
}  // namespace biotomy::reconstruct
