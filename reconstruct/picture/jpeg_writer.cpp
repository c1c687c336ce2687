#include "reconstruct/picture/jpeg_writer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/jpeg_library.hpp"
#include "reconstruct/picture/rgb_picture.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr double kLevels16To8 = 1.0 / 257.0;
constexpr std::size_t kLongestComment = 65533;

/// JFIF's X and Y density and their unit.
struct Density {
  std::uint8_t unit = 0;  ///< 0: none, but the pixels are square
  std::uint16_t dots = 1;
};

constexpr std::uint8_t kInch = 1;
constexpr std::uint8_t kCentimetre = 2;

Density density_of(double pixel) {
  constexpr double kTolerance = 0.01;
  Density best;
  double least = kTolerance;
  for (const auto& [unit, micrometres] : {std::pair{kCentimetre, 10'000.0}, {kInch, 25'400.0}}) {
    const double exact = micrometres / pixel;
    const double dots = std::round(exact);
    if (!(pixel > 0.0) || dots < 1.0 || dots > 65535.0) {
      continue;
    }
    const double error = std::abs(dots / exact - 1.0);
    if (error < least) {
      least = error;
      best = {unit, static_cast<std::uint16_t>(dots)};
    }
  }
  return best;
}

/// A file in the making. libjpeg jumps out of `encode` on an error, so that nothing there may need
/// a destructor; this has it.
class Compressor {
 public:
  Compressor() {
    codec_.err = &report_.manager;
    created_ = setjmp(report_.place) == 0 && create();
  }
  ~Compressor() {
    if (created_) {
      jpeg_destroy_compress(&codec_);
    }
    std::free(memory_);
  }
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;

  bool encode(const cv::Mat& rgb, const Density& density, const std::string& comment, int quality) {
    if (!created_ || setjmp(report_.place) != 0) {
      memory_ = nullptr;  // may be freed already: libjpeg tells of a larger one only at the end
      return false;
    }
    jpeg_mem_dest(&codec_, &memory_, &size_);
    codec_.image_width = static_cast<JDIMENSION>(rgb.cols);
    codec_.image_height = static_cast<JDIMENSION>(rgb.rows);
    codec_.input_components = 3;
    codec_.in_color_space = JCS_RGB;
    jpeg_set_defaults(&codec_);
    jpeg_set_quality(&codec_, quality, TRUE);
    codec_.comp_info[0].h_samp_factor = 1;  // colours at full resolution
    codec_.comp_info[0].v_samp_factor = 1;
    codec_.density_unit = density.unit;
    codec_.X_density = density.dots;
    codec_.Y_density = density.dots;
    jpeg_start_compress(&codec_, TRUE);
    if (!comment.empty()) {
      jpeg_write_marker(&codec_, JPEG_COM, reinterpret_cast<const JOCTET*>(comment.data()),
                        static_cast<unsigned>(comment.size()));
    }
    while (codec_.next_scanline < codec_.image_height) {
      auto* row = const_cast<JSAMPROW>(rgb.ptr(static_cast<int>(codec_.next_scanline)));
      jpeg_write_scanlines(&codec_, &row, 1);
    }
    jpeg_finish_compress(&codec_);
    return true;
  }

  const std::byte* begin() const { return reinterpret_cast<const std::byte*>(memory_); }
  const std::byte* end() const { return begin() + size_; }
  const char* message() const { return report_.message(); }

 private:
  bool create() {
    jpeg_create_compress(&codec_);
    return true;
  }

  JpegReport report_;
  jpeg_compress_struct codec_{};
  unsigned char* memory_ = nullptr;
  unsigned long size_ = 0;
  bool created_ = false;
};

}  // namespace

std::vector<std::byte> encode_jpeg(const cv::Mat& rgb, const PictureNotes& notes, int quality) {
  require_rgb_picture(rgb);
  if (quality < 1 || quality > 100) {
    throw InvalidRequest("the quality of a JPEG is 1 to 100");
  }
  if (std::max(rgb.cols, rgb.rows) > kLongestJpegSide) {
    throw SampleError("a JPEG has at most " + std::to_string(kLongestJpegSide) +
                      " pixels along a side, and the picture has " + std::to_string(rgb.cols) +
                      " x " + std::to_string(rgb.rows) +
                      ": write a PNG or a TIFF, or ask for a larger pixel");
  }
  if (notes.description.size() > kLongestComment) {
    throw SampleError("the description is too long for a JPEG: write a PNG or a TIFF");
  }
  cv::Mat levels = rgb;
  if (rgb.depth() == CV_16U) {
    rgb.convertTo(levels, CV_8U, kLevels16To8);
  }
  Compressor file;
  if (!file.encode(levels, density_of(notes.pixel), notes.description, quality)) {
    throw SampleError(std::string("the picture can't be encoded as a JPEG: ") + file.message());
  }
  return {file.begin(), file.end()};
}

}  // namespace biotomy::reconstruct
