#include "reconstruct/picture/png_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <png.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/image_size.hpp"
#include "reconstruct/picture/inflated_png.hpp"

namespace biotomy::reconstruct {
namespace {

/// The pixels' sum is not checked. (Some builds of libpng check it all the same.)
void leave_sum_unchecked([[maybe_unused]] png_structp png) {
#ifdef PNG_IGNORE_ADLER32
  png_set_option(png, PNG_IGNORE_ADLER32, PNG_OPTION_ON);
#endif
}

/// A file being read. libpng jumps out of the methods on an error, so that nothing in them may
/// need a destructor; this has it.
class Reader {
 public:
  Reader(std::vector<std::span<const std::byte>> parts, bool is_checked)
      : parts_(std::move(parts)), is_checked_(is_checked) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
  }
  ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  bool read_header() {
    if (info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0) {
      return false;
    }
    png_set_read_fn(png_, this, read);
    png_set_user_limits(png_, kLongestSide, kLongestSide);
    png_set_crc_action(png_, PNG_CRC_QUIET_USE, PNG_CRC_QUIET_USE);
    if (is_checked_) {
      leave_sum_unchecked(png_);
    }
    png_read_info(png_, info_);
    png_set_expand_gray_1_2_4_to_8(png_);
    png_set_palette_to_rgb(png_);
    png_set_gray_to_rgb(png_);
    png_set_strip_alpha(png_);
    if (std::endian::native == std::endian::little) {
      png_set_swap(png_);
    }
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }

  std::uint32_t width() { return png_get_image_width(png_, info_); }
  std::uint32_t height() { return png_get_image_height(png_, info_); }
  int bits() { return png_get_bit_depth(png_, info_); }
  std::size_t row_bytes() { return png_get_rowbytes(png_, info_); }

  bool read_pixels(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) {
      return false;
    }
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  const char* message() const { return message_.data(); }

 private:
  static void fail(png_structp png, png_const_charp message) {
    auto& reader = *static_cast<Reader*>(png_get_error_ptr(png));
    std::strncpy(reader.message_.data(), message, reader.message_.size() - 1);
    png_longjmp(png, 1);
  }
  static void ignore(png_structp, png_const_charp) {}
  static void read(png_structp png, png_bytep bytes, std::size_t size) {
    auto& reader = *static_cast<Reader*>(png_get_io_ptr(png));
    while (size > 0) {
      if (reader.part_ == reader.parts_.size()) {
        png_error(png, "it is truncated");
      }
      std::span<const std::byte>& part = reader.parts_[reader.part_];
      const std::size_t count = std::min(size, part.size());
      std::memcpy(bytes, part.data(), count);
      part = part.subspan(count);
      reader.part_ += part.empty() ? 1 : 0;
      bytes += count;
      size -= count;
    }
  }

  std::vector<std::span<const std::byte>> parts_;
  std::size_t part_ = 0;
  bool is_checked_;  ///< the sum of the pixels, by whoever inflated them
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::array<char, 128> message_{};
};

}  // namespace

cv::Mat decode_png(std::span<const std::byte> file) {
  const std::optional<InflatedPng> inflated = InflatedPng::of(file);
  Reader picture(inflated ? inflated->parts() : std::vector{file}, inflated.has_value());
  if (!picture.read_header()) {
    throw SampleError(std::string("cannot be decoded: ") + picture.message());
  }
  cv::Mat rgb;
  if (!is_image_size(picture.width(), picture.height())) {
    throw SampleError("its size makes no sense");
  }
  rgb.create(static_cast<int>(picture.height()), static_cast<int>(picture.width()),
             picture.bits() == 16 ? CV_16UC3 : CV_8UC3);
  if (picture.row_bytes() != static_cast<std::size_t>(rgb.cols) * rgb.elemSize()) {
    throw SampleError("its pixels are laid out in a way that is not supported: convert it");
  }
  std::vector<png_bytep> rows(static_cast<std::size_t>(rgb.rows));
  for (int y = 0; y < rgb.rows; ++y) {
    rows[static_cast<std::size_t>(y)] = rgb.ptr(y);
  }
  if (!picture.read_pixels(rows.data())) {
    throw SampleError(std::string("cannot be decoded: ") + picture.message());
  }
  return rgb;
}

}  // namespace biotomy::reconstruct
