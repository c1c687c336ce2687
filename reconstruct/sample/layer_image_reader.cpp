#include <algorithm>
#include <cstring>

#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/image_size.hpp"
#include "reconstruct/picture/tiff_file.hpp"
#include "reconstruct/sample/layer_image.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr int kChannels = 3;
constexpr std::uint32_t kLongestTileSide = 1U << 11;  // 25 MB decoded

/// libtiff knows many more; what a layer can be in is lossless.
bool is_lossless(std::uint16_t compression) {
  return compression == COMPRESSION_NONE || compression == COMPRESSION_LZW ||
         compression == COMPRESSION_ADOBE_DEFLATE || compression == COMPRESSION_DEFLATE ||
         compression == COMPRESSION_ZSTD;
}

}  // namespace

LayerImageReader::LayerImageReader(const std::filesystem::path& path)
    : file_(std::make_unique<TiffFile>(TiffFile::open(path))) {
  const auto width = file_->number<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
  const auto height = file_->number<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
  const auto tile_width = file_->number<std::uint32_t>(TIFFTAG_TILEWIDTH, 0);
  const auto tile_height = file_->number<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
  const auto bits = file_->number<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 0);
  if (TIFFIsTiled(file_->get()) == 0 || (bits != 8 && bits != 16) ||
      file_->number<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 0) != kChannels ||
      file_->number<std::uint16_t>(TIFFTAG_PHOTOMETRIC, 0) != PHOTOMETRIC_RGB ||
      file_->number<std::uint16_t>(TIFFTAG_PLANARCONFIG, 0) != PLANARCONFIG_CONTIG) {
    file_->fail("is not a layer image: expected a tiled RGB TIFF of 8 or 16 bits");
  }
  if (!is_image_size(width, height) || tile_width == 0 || tile_height == 0 ||
      tile_width > kLongestTileSide || tile_height > kLongestTileSide) {
    file_->fail("is not a layer image: its size makes no sense");
  }
  const auto compression = file_->number<std::uint16_t>(TIFFTAG_COMPRESSION, 0);
  if (!is_lossless(compression) || TIFFIsCODECConfigured(compression) == 0) {
    file_->fail("is compressed in a way that is not lossless or that this libtiff does not know");
  }
  width_ = static_cast<int>(width);
  height_ = static_cast<int>(height);
  tile_width_ = static_cast<int>(tile_width);
  tile_height_ = static_cast<int>(tile_height);
  type_ = bits == 8 ? CV_8UC3 : CV_16UC3;
}

LayerImageReader::~LayerImageReader() = default;

cv::Mat LayerImageReader::read(const cv::Rect& region) {
  cv::Mat image(region.size(), type_);
  cv::Mat tile(tile_height_, tile_width_, type_);
  const auto tile_bytes = static_cast<tmsize_t>(tile.total() * tile.elemSize());
  const int first_x = region.x / tile_width_ * tile_width_;
  const int first_y = region.y / tile_height_ * tile_height_;
  for (int y = first_y; y < region.br().y; y += tile_height_) {
    for (int x = first_x; x < region.br().x; x += tile_width_) {
      const std::uint32_t number = TIFFComputeTile(file_->get(), static_cast<std::uint32_t>(x),
                                                   static_cast<std::uint32_t>(y), 0, 0);
      if (TIFFReadEncodedTile(file_->get(), number, tile.data, tile_bytes) != tile_bytes) {
        file_->fail("is damaged or truncated: the tile at column " + std::to_string(x) + ", row " +
                    std::to_string(y) + " cannot be read");
      }
      const cv::Rect wanted = cv::Rect(x, y, tile_width_, tile_height_) & region;
      tile(wanted - cv::Point(x, y)).copyTo(image(wanted - region.tl()));
    }
  }
  return image;
}

cv::Mat read_layer_image(const std::filesystem::path& path) {
  LayerImageReader reader(path);
  return reader.read({0, 0, reader.width(), reader.height()});
}

}  // namespace biotomy::reconstruct
