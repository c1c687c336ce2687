#include "reconstruct/picture/tiff_image.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "reconstruct/picture/image_size.hpp"
#include "reconstruct/picture/tiff_file.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr int kMostSamples = 8;

/// How a TIFF is laid out, checked.
struct Structure {
  int width = 0;
  int height = 0;
  int block_width = 0;  ///< of a tile, or of a strip
  int block_height = 0;
  int depth = CV_8U;
  int samples = 1;  ///< of a pixel
  bool planar = false;
  bool tiled = false;
  std::uint16_t photometric = 0;
};

Structure structure_of(const TiffFile& file) {
  const auto width = file.number<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
  const auto height = file.number<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
  const auto samples = file.number<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
  const auto bits = file.number<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
  const auto sample_format = file.number<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  const auto compression = file.number<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  if (!is_image_size(width, height)) {
    file.fail("its size makes no sense");
  }
  if (samples == 0 || samples > kMostSamples) {
    file.fail("has " + std::to_string(samples) + " samples a pixel: convert it to grey or RGB");
  }
  if ((bits != 8 && bits != 16) || sample_format != SAMPLEFORMAT_UINT) {
    const char* const kind = sample_format == SAMPLEFORMAT_UINT     ? "unsigned"
                             : sample_format == SAMPLEFORMAT_INT    ? "signed"
                             : sample_format == SAMPLEFORMAT_IEEEFP ? "floating-point"
                                                                    : "other";
    file.fail("has colours of " + std::to_string(bits) + " bits, " + kind +
              "; expected 8 or 16 bits, unsigned: convert it");
  }
  if (TIFFIsCODECConfigured(compression) == 0) {
    file.fail("is compressed in a way that this libtiff does not know: convert it");
  }
  Structure structure;
  structure.width = static_cast<int>(width);
  structure.height = static_cast<int>(height);
  structure.depth = bits == 8 ? CV_8U : CV_16U;
  structure.samples = samples;
  structure.photometric = file.number<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  structure.planar = file.number<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) ==
                     PLANARCONFIG_SEPARATE;
  structure.tiled = TIFFIsTiled(file.get()) != 0;
  const auto block_width =
      structure.tiled ? file.number<std::uint32_t>(TIFFTAG_TILEWIDTH, 0) : width;
  const auto block_height =
      structure.tiled ? file.number<std::uint32_t>(TIFFTAG_TILELENGTH, 0)
                      : std::min(height, file.number<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, height));
  if (!is_image_size(block_width, block_height)) {
    file.fail("the size of its strips or tiles makes no sense");
  }
  structure.block_width = static_cast<int>(block_width);
  structure.block_height = static_cast<int>(block_height);
  return structure;
}

/// Decodes the strip or tile whose first pixel is (x, y) into `block`, of which `rows` are wanted.
void read_block(const TiffFile& file, const Structure& structure, int x, int y, int rows,
                std::uint16_t plane, cv::Mat& block) {
  const auto row = static_cast<std::uint32_t>(y);
  const auto wanted = static_cast<tmsize_t>(block.step[0] * static_cast<std::size_t>(rows));
  const auto whole = static_cast<tmsize_t>(block.step[0] * static_cast<std::size_t>(block.rows));
  const tmsize_t got =
      structure.tiled
          ? TIFFReadEncodedTile(
                file.get(),
                TIFFComputeTile(file.get(), static_cast<std::uint32_t>(x), row, 0, plane),
                block.data, whole)
          : TIFFReadEncodedStrip(file.get(), TIFFComputeStrip(file.get(), row, plane), block.data,
                                 wanted);
  if (got < wanted) {
    file.fail("is damaged or truncated: row " + std::to_string(y) + " cannot be read");
  }
}

/// All samples of `plane` (contiguous files have just the plane 0, with all samples of a pixel).
cv::Mat read_plane(const TiffFile& file, const Structure& structure, std::uint16_t plane) {
  const int type = CV_MAKETYPE(structure.depth, structure.planar ? 1 : structure.samples);
  cv::Mat image(structure.height, structure.width, type);
  cv::Mat block(structure.block_height, structure.block_width, type);
  const auto plain_bytes = static_cast<std::uint64_t>(block.total() * block.elemSize());
  const std::uint64_t file_bytes =
      structure.tiled ? static_cast<std::uint64_t>(TIFFTileSize64(file.get()))
                      : TIFFVStripSize64(file.get(), static_cast<std::uint32_t>(block.rows));
  if (plain_bytes != file_bytes) {
    file.fail("its pixels are laid out in a way that is not supported: convert it");
  }
  for (int y = 0; y < structure.height; y += structure.block_height) {
    const int rows = std::min(structure.block_height, structure.height - y);
    for (int x = 0; x < structure.width; x += structure.block_width) {
      read_block(file, structure, x, y, rows, plane, block);
      const cv::Rect part(x, y, std::min(structure.block_width, structure.width - x), rows);
      block(cv::Rect({0, 0}, part.size())).copyTo(image(part));
    }
  }
  return image;
}

/// The wanted samples of each pixel, one image a sample.
std::vector<cv::Mat> read_samples(const TiffFile& file, const Structure& structure, int wanted) {
  std::vector<cv::Mat> samples;
  if (structure.planar) {
    for (int plane = 0; plane < wanted; ++plane) {
      samples.push_back(read_plane(file, structure, static_cast<std::uint16_t>(plane)));
    }
  } else {
    const cv::Mat image = read_plane(file, structure, 0);
    for (int sample = 0; sample < wanted; ++sample) {
      cv::Mat one;
      cv::extractChannel(image, one, sample);
      samples.push_back(one);
    }
  }
  return samples;
}

/// Of each pixel, those that the file declares to be no colours, as alpha is.
int extra_samples(const TiffFile& file) {
  std::uint16_t count = 0;
  std::uint16_t* kinds = nullptr;
  return TIFFGetField(file.get(), TIFFTAG_EXTRASAMPLES, &count, &kinds) == 1 ? count : 0;
}

/// The page that the file is turned to.
cv::Mat read_page(const TiffFile& file) {
  if (file.number<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_JPEG) {
    TIFFSetField(file.get(), TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);  // rather than YCbCr
  }
  const Structure structure = structure_of(file);
  const bool jpeg_colour =
      structure.photometric == PHOTOMETRIC_YCBCR &&
      file.number<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_JPEG;
  cv::Mat rgb;
  if ((structure.photometric == PHOTOMETRIC_RGB || jpeg_colour) && structure.samples >= 3) {
    if (!structure.planar && structure.samples == 3) {
      return read_plane(file, structure, 0);
    }
    cv::merge(read_samples(file, structure, 3), rgb);
    return rgb;
  }
  const bool is_grey = structure.photometric == PHOTOMETRIC_MINISBLACK ||
                       structure.photometric == PHOTOMETRIC_MINISWHITE;
  if (is_grey && structure.samples - extra_samples(file) > 1) {
    file.fail("has " + std::to_string(structure.samples) +
              " samples a pixel and says that they are grey: convert it to RGB");
  }
  if (is_grey) {
    cv::Mat grey = read_samples(file, structure, 1).front();
    if (structure.photometric == PHOTOMETRIC_MINISWHITE) {
      cv::bitwise_not(grey, grey);
    }
    cv::cvtColor(grey, rgb, cv::COLOR_GRAY2RGB);
    return rgb;
  }
  file.fail("is neither grey nor RGB: convert it");
}

}  // namespace

cv::Mat read_tiff_image(const std::filesystem::path& path) {
  const TiffFile file = TiffFile::open(path);
  go_to_only_picture(file);
  return read_page(file);
}

cv::Mat read_tiff_page(const std::filesystem::path& path, TiffPage page) {
  const TiffFile file = TiffFile::open(path);
  go_to_page(file, page);
  return read_page(file);
}

}  // namespace biotomy::reconstruct
