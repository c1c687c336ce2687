#include "reconstruct/picture/jpeg_reader.hpp"

#include <string>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/image_size.hpp"
#include "reconstruct/picture/jpeg_library.hpp"

namespace biotomy::reconstruct {
namespace {

/// A file being read. libjpeg jumps out of the methods on an error, so that nothing in them may
/// need a destructor; this has it.
class Decompressor {
 public:
  explicit Decompressor(ExtraneousBytes extraneous) {
    report_.hears_of_extraneous_bytes = extraneous == ExtraneousBytes::are_damage;
    codec_.err = &report_.manager;
    created_ = setjmp(report_.place) == 0 && create();
  }
  ~Decompressor() {
    if (created_) {
      jpeg_destroy_decompress(&codec_);
    }
  }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  bool read_header(std::span<const std::byte> file) {
    if (!created_ || setjmp(report_.place) != 0) {
      return false;
    }
    jpeg_mem_src(&codec_, reinterpret_cast<const unsigned char*>(file.data()),
                 static_cast<unsigned long>(file.size()));
    jpeg_read_header(&codec_, TRUE);
    codec_.out_color_space = JCS_RGB;
    return true;
  }

  bool is_cmyk() const {
    return codec_.jpeg_color_space == JCS_CMYK || codec_.jpeg_color_space == JCS_YCCK;
  }
  int width() const { return static_cast<int>(codec_.image_width); }
  int height() const { return static_cast<int>(codec_.image_height); }

  /// `rgb` is CV_8UC3 and has the size of the picture.
  bool read_pixels(cv::Mat& rgb) {
    if (setjmp(report_.place) != 0) {
      return false;
    }
    jpeg_start_decompress(&codec_);
    while (codec_.output_scanline < codec_.output_height) {
      JSAMPROW row = rgb.ptr(static_cast<int>(codec_.output_scanline));
      jpeg_read_scanlines(&codec_, &row, 1);
    }
    jpeg_finish_decompress(&codec_);
    return codec_.err->num_warnings == 0;
  }

  const char* message() const { return report_.message(); }

 private:
  bool create() {
    jpeg_create_decompress(&codec_);
    return true;
  }

  JpegReport report_;
  jpeg_decompress_struct codec_{};
  bool created_ = false;
};

}  // namespace

cv::Mat decode_jpeg(std::span<const std::byte> file, ExtraneousBytes extraneous) {
  Decompressor picture(extraneous);
  if (!picture.read_header(file)) {
    throw SampleError(std::string("cannot be decoded: ") + picture.message());
  }
  if (picture.is_cmyk()) {
    throw SampleError("is a CMYK JPEG, whose colours depend on a printer: convert it to RGB");
  }
  if (!is_image_size(static_cast<std::uint64_t>(picture.width()),
                     static_cast<std::uint64_t>(picture.height()))) {
    throw SampleError("its size makes no sense");
  }
  cv::Mat rgb(picture.height(), picture.width(), CV_8UC3);
  if (!picture.read_pixels(rgb)) {
    throw SampleError(std::string("is damaged: ") + picture.message());
  }
  return rgb;
}

}  // namespace biotomy::reconstruct
