#include "reconstruct/sample/layer_image.hpp"

#include <array>
#include <cmath>
#include <tuple>

#include <gmock/gmock.h>
#include <tiffio.h>

#include "reconstruct/disk/sha256.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/picture/tiff_file.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using tests::TemporaryFolder;

const LayerPosition kPosition{7, {10.0, 20.0, 50.0}};

/// Through libtiff alone, as any other program would.
cv::Mat read_with_libtiff(const std::filesystem::path& path) {
  TIFF* tiff = TIFFOpen(path.c_str(), "r");
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint16_t bits = 0;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
  TIFFGetField(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
  cv::Mat padded(static_cast<int>((height + 255) / 256 * 256),
                 static_cast<int>((width + 255) / 256 * 256), bits == 8 ? CV_8UC3 : CV_16UC3);
  cv::Mat tile(256, 256, padded.type());
  for (int y = 0; y < padded.rows; y += 256) {
    for (int x = 0; x < padded.cols; x += 256) {
      EXPECT_EQ(TIFFReadTile(tiff, tile.data, static_cast<std::uint32_t>(x),
                             static_cast<std::uint32_t>(y), 0, 0),
                static_cast<tmsize_t>(tile.total() * tile.elemSize()));
      tile.copyTo(padded(cv::Rect(x, y, 256, 256)));
    }
  }
  TIFFClose(tiff);
  return padded(cv::Rect(0, 0, static_cast<int>(width), static_cast<int>(height))).clone();
}

class EveryLayerFormat
    : public testing::TestWithParam<std::tuple<LayerCompression, int, cv::Size>> {
 protected:
  TemporaryFolder folder_;
};

TEST_P(EveryLayerFormat, IsReadIdenticallyByUsAndByLibtiff) {
  const auto& [compression, type, size] = GetParam();
  const cv::Mat image = test_image(size.width, size.height, type);
  const auto path = folder_.path() / "000007.tif";
  write_layer_image(path, image, kPosition, {compression, 1});
  EXPECT_TRUE(same_pixels(read_layer_image(path), image));
  EXPECT_TRUE(same_pixels(read_with_libtiff(path), image));
}

INSTANTIATE_TEST_SUITE_P(
    Formats, EveryLayerFormat,
    testing::Combine(testing::Values(LayerCompression::zstd, LayerCompression::deflate),
                     testing::Values(CV_8UC3, CV_16UC3),
                     testing::Values(cv::Size(1, 1), cv::Size(256, 256), cv::Size(300, 513))));

/// A TIFF that says all that a layer image says, of this size along both axes; just its first tile
/// is stored, and holds nothing that could be decoded.
void write_tiled_tiff(const std::filesystem::path& path, int compression, int side, int tile) {
  std::vector<std::byte> memory;
  TiffFile file = TiffFile::create(memory, false, path);
  file.set(TIFFTAG_IMAGEWIDTH, side);
  file.set(TIFFTAG_IMAGELENGTH, side);
  file.set(TIFFTAG_TILEWIDTH, tile);
  file.set(TIFFTAG_TILELENGTH, tile);
  file.set(TIFFTAG_SAMPLESPERPIXEL, 3);
  file.set(TIFFTAG_BITSPERSAMPLE, 8);
  file.set(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  file.set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  file.set(TIFFTAG_COMPRESSION, compression);
  std::array<std::byte, 4> nothing{};
  TIFFWriteRawTile(file.get(), 0, nothing.data(), nothing.size());
  file.finish();
  write_file(path, memory);
}

class LayerImage : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "000007.tif";
  cv::Mat image_ = test_image(600, 500);
};

TEST_F(LayerImage, IsReadIdenticallyByOpenCv) {
  write_layer_image(path_, image_, kPosition, {LayerCompression::deflate, 1});
  cv::Mat rgb;
  cv::cvtColor(cv::imread(path_.string(), cv::IMREAD_UNCHANGED), rgb, cv::COLOR_BGR2RGB);
  EXPECT_TRUE(same_pixels(rgb, image_));
}

TEST_F(LayerImage, ReportsTheSizeAndTheHashOfTheFile) {
  const StoredLayer stored = write_layer_image(path_, image_, kPosition, {});
  EXPECT_EQ(stored.bytes, std::filesystem::file_size(path_));
  EXPECT_EQ(stored.sha256, sha256_of_file(path_));
}

TEST_F(LayerImage, CarriesItsPlaceInTheSample) {
  write_layer_image(path_, image_, kPosition, {});
  TIFF* tiff = TIFFOpen(path_.c_str(), "r");
  float pixels_per_cm = 0;
  const char* description = nullptr;
  TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &pixels_per_cm);
  TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &description);
  EXPECT_FLOAT_EQ(pixels_per_cm, 1000.0F);
  EXPECT_STREQ(description, R"({"layer":7,"spacing_um":[10.0,20.0,50.0],"z_um":300.0})");
  TIFFClose(tiff);
}

TEST_F(LayerImage, LargerThanAClassicTiffBecomesABigTiff) {
  LayerFormat format;
  format.largest_classic_tiff = 100'000;
  write_layer_image(path_, image_, kPosition, format);
  EXPECT_EQ(std::to_integer<int>(read_file(path_)[2]), 43);  // a classic TIFF has 42
  EXPECT_TRUE(same_pixels(read_layer_image(path_), image_));
}

TEST_F(LayerImage, ReplacesTheFileAndLeavesNothingBeside) {
  write_layer_image(path_, test_image(10, 10), kPosition, {});
  write_layer_image(path_, image_, kPosition, {});
  EXPECT_TRUE(same_pixels(read_layer_image(path_), image_));
  EXPECT_THAT(names_in(folder_.path()), testing::ElementsAre("000007.tif"));
}

TEST_F(LayerImage, OnlyPreparedIsNotThere) {
  const PublishLayer publish = prepare_layer_image(path_, image_, kPosition, {});
  EXPECT_FALSE(std::filesystem::exists(path_));
  const StoredLayer stored = publish();
  EXPECT_EQ(stored.sha256, sha256_of_file(path_));
  EXPECT_TRUE(same_pixels(read_layer_image(path_), image_));
}

TEST_F(LayerImage, OnlyPreparedAndGivenUpLeavesNothing) {
  prepare_layer_image(path_, image_, kPosition, {});
  EXPECT_TRUE(names_in(folder_.path()).empty());
}

TEST_F(LayerImage, RefusesAGreyImage) {
  EXPECT_THROW(write_layer_image(path_, cv::Mat(4, 4, CV_8UC1), kPosition, {}), SampleError);
  EXPECT_TRUE(names_in(folder_.path()).empty());
}

TEST_F(LayerImage, RegionIsThatPartOfTheImage) {
  write_layer_image(path_, image_, kPosition, {});
  LayerImageReader reader(path_);
  EXPECT_EQ(reader.width(), 600);
  EXPECT_EQ(reader.height(), 500);
  for (const cv::Rect& region : {cv::Rect(250, 250, 10, 10), cv::Rect(0, 0, 600, 1),
                                 cv::Rect(599, 499, 1, 1), cv::Rect(256, 0, 256, 256)}) {
    EXPECT_TRUE(same_pixels(reader.read(region), image_(region))) << region;
  }
}

TEST_F(LayerImage, TruncatedAnywhereIsAnErrorAndPrintsNothing) {
  write_layer_image(path_, image_, kPosition, {});
  const auto whole = read_file(path_);
  for (const double share : {0.0, 0.001, 0.3, 0.7, 0.98}) {
    write_file(path_, whole);
    truncate_file(path_, share);
    testing::internal::CaptureStderr();
    const std::string message = message_of<SampleError>([&] { read_layer_image(path_); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_THAT(message, StartsWith(path_.string())) << share;
    EXPECT_THAT(message, testing::Not(HasSubstr("\n")));
  }
}

TEST_F(LayerImage, DamagedTileNamesItsPlaceAndWhatLibtiffSaid) {
  write_layer_image(path_, image_, kPosition, {});
  // Past the header of 8 bytes, the first tile's zstd frame begins with its magic number.
  flip_byte(path_, 8);
  EXPECT_THAT(
      message_of<SampleError>([&] { read_layer_image(path_); }),
      testing::AllOf(StartsWith(path_.string()), HasSubstr("column 0, row 0"), HasSubstr("(")));
}

TEST_F(LayerImage, RefusesATiffThatIsNotTiled) {
  cv::imwrite(path_.string(), image_);
  EXPECT_THAT(message_of<SampleError>([&] { read_layer_image(path_); }),
              HasSubstr("not a layer image"));
}

TEST_F(LayerImage, MissingFileIsSaidSo) {
  EXPECT_THAT(message_of<SampleError>([&] { read_layer_image(path_); }), HasSubstr("No such file"));
}

TEST_F(LayerImage, RefusesAnImageThatLostSomethingToItsCompression) {
  write_tiled_tiff(path_, COMPRESSION_JPEG, 16, 16);
  EXPECT_THAT(message_of<SampleError>([&] { LayerImageReader reader(path_); }),
              HasSubstr("not lossless"));
}

TEST_F(LayerImage, RefusesTilesAndImagesThatNoMemoryHolds) {
  write_tiled_tiff(path_, COMPRESSION_NONE, 16, 4096);
  EXPECT_THAT(message_of<SampleError>([&] { LayerImageReader reader(path_); }),
              HasSubstr("size makes no sense"));
  write_tiled_tiff(path_, COMPRESSION_NONE, 1 << 17, 2048);
  EXPECT_THAT(message_of<SampleError>([&] { LayerImageReader reader(path_); }),
              HasSubstr("size makes no sense"));
}

TEST_F(LayerImage, AChangedByteOfATileIsNoticed) {
  write_layer_image(path_, image_, kPosition, {});
  const auto whole = read_file(path_);
  // The tiles come first, right after the header of 8 bytes.
  for (std::size_t place = 8; place < whole.size() / 2; place += whole.size() / 40) {
    flip_byte(path_, place);
    EXPECT_THROW(read_layer_image(path_), SampleError) << place;
    write_file(path_, whole);
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
