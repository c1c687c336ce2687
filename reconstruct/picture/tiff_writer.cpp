#include "reconstruct/picture/tiff_writer.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

#include <oneapi/tbb/parallel_for.h>

#include "reconstruct/picture/rgb_picture.hpp"
#include "reconstruct/picture/strip_deflate.hpp"
#include "reconstruct/picture/tiff_file.hpp"

namespace biotomy::reconstruct {
namespace {

using Bytes = std::vector<std::byte>;

constexpr int kColours = 3;
constexpr double kMicrometresPerCentimetre = 1e4;
constexpr std::size_t kStripBytes = std::size_t{1} << 18;  // of rows; a unit of parallel work
constexpr std::size_t kClassicBytes = 0xF0000000;          // a TIFF ends at 4 GiB

/// Each value less the same colour of the pixel on its left (TIFF 6.0, section 14: predictor 2).
template <typename Level>
std::vector<std::uint8_t> predicted_rows(const cv::Mat& rgb, int first, int end) {
  const std::size_t levels = static_cast<std::size_t>(rgb.cols) * kColours;
  std::vector<std::uint8_t> bytes(levels * sizeof(Level) * static_cast<std::size_t>(end - first));
  auto* out = reinterpret_cast<Level*>(bytes.data());
  for (int y = first; y < end; ++y, out += levels) {
    const auto* in = rgb.ptr<Level>(y);
    std::copy_n(in, kColours, out);
    for (std::size_t i = kColours; i < levels; ++i) {
      out[i] = static_cast<Level>(in[i] - in[i - kColours]);
    }
  }
  return bytes;
}

std::vector<Bytes> encode_strips(const cv::Mat& rgb, int rows) {
  std::vector<Bytes> strips(static_cast<std::size_t>((rgb.rows + rows - 1) / rows));
  tbb::parallel_for(std::size_t{0}, strips.size(), [&](std::size_t number) {
    const int first = static_cast<int>(number) * rows;
    const int end = std::min(first + rows, rgb.rows);
    strips[number] =
        zlib_stream(rgb.depth() == CV_8U ? predicted_rows<std::uint8_t>(rgb, first, end)
                                         : predicted_rows<std::uint16_t>(rgb, first, end));
  });
  return strips;
}

void write_tags(TiffFile& file, const cv::Mat& rgb, int rows, const PictureNotes& notes) {
  file.set(TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(rgb.cols));
  file.set(TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(rgb.rows));
  file.set(TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(rows));
  file.set(TIFFTAG_SAMPLESPERPIXEL, kColours);
  file.set(TIFFTAG_BITSPERSAMPLE, static_cast<int>(8 * rgb.elemSize1()));
  file.set(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  file.set(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  file.set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  file.set(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  file.set(TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  file.set(TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
  if (notes.pixel > 0.0) {
    file.set(TIFFTAG_RESOLUTIONUNIT, RESUNIT_CENTIMETER);
    file.set(TIFFTAG_XRESOLUTION, kMicrometresPerCentimetre / notes.pixel);
    file.set(TIFFTAG_YRESOLUTION, kMicrometresPerCentimetre / notes.pixel);
  }
  if (!notes.title.empty()) {
    file.set(TIFFTAG_DOCUMENTNAME, notes.title.c_str());
  }
  if (!notes.description.empty()) {
    file.set(TIFFTAG_IMAGEDESCRIPTION, notes.description.c_str());
  }
  file.set(TIFFTAG_SOFTWARE, "Biotomy " BIOTOMY_VERSION);
}

}  // namespace

std::vector<std::byte> encode_tiff(const cv::Mat& rgb, const PictureNotes& notes) {
  require_rgb_picture(rgb);
  const std::size_t row_bytes = static_cast<std::size_t>(rgb.cols) * rgb.elemSize();
  const int rows = static_cast<int>(
      std::clamp<std::size_t>(kStripBytes / row_bytes, 1, static_cast<std::size_t>(rgb.rows)));
  std::vector<Bytes> strips = encode_strips(rgb, rows);
  // The tags and the tables of strips come on top: 16 bytes a strip at most, and some change.
  std::size_t size = 4096 + notes.title.size() + notes.description.size() + 16 * strips.size();
  for (const Bytes& strip : strips) {
    size += strip.size();
  }
  Bytes memory;
  memory.reserve(size);
  TiffFile file = TiffFile::create(memory, size > kClassicBytes, "the picture");
  write_tags(file, rgb, rows, notes);
  for (std::size_t number = 0; number < strips.size(); ++number) {
    Bytes& strip = strips[number];
    const auto strip_bytes = static_cast<tmsize_t>(strip.size());
    if (TIFFWriteRawStrip(file.get(), static_cast<std::uint32_t>(number), strip.data(),
                          strip_bytes) != strip_bytes) {
      file.fail("cannot put its strips together");
    }
    strip = {};  // the file in memory has it now
  }
  file.finish();
  return memory;
}

}  // namespace biotomy::reconstruct
