#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include <opencv2/core/mat.hpp>

namespace biotomy::bridge {

/// A camera's way to lay out pixels, by the order of the bytes in memory (libcamera and DRM name
/// `rgb24` BGR888 and `bgr24` RGB888, after the little-endian number).
enum class PixelFormat {
  rgb24,  ///< bytes R, G, B
  bgr24,  ///< bytes B, G, R
  nv12,   ///< a plane Y, then a plane of U, V pairs at half width and height
  yuyv,   ///< bytes Y0, U, Y1, V for two pixels
  mjpeg,  ///< one JPEG file
};

/// Which numbers the YUV formats use: 16 to 235 for black to white, or 0 to 255.
enum class YuvRange { limited, full };

/// How Y, U and V were made from R, G and B: ITU-R BT.601-7, BT.709-6 or BT.2020-2.
enum class YuvMatrix { bt601, bt709, bt2020 };

/// The coding of a YUV stream; the default is what cameras use that don't tell.
struct YuvCoding {
  YuvMatrix matrix = YuvMatrix::bt601;
  YuvRange range = YuvRange::limited;

  friend bool operator==(const YuvCoding&, const YuvCoding&) = default;
};

/// A part of a frame. `bytes` is all that was written to it; `stride` the bytes from row to row.
struct PixelPlane {
  std::span<const std::uint8_t> bytes;
  std::size_t stride = 0;
};

/// A buffer that does not hold the picture it should: too short, or no whole JPEG.
class PixelError : public std::runtime_error {
 public:
  explicit PixelError(const std::string& message) : std::runtime_error(message) {}
};

/// Converts a frame to height × width CV_8UC3 in the order R, G, B. `planes` has one element, or
/// two for nv12 (one will do if it holds both, the second right after the first with the same
/// stride). `coding` is of the YUV formats; a JPEG file has its own (JFIF: BT.601, full range).
/// nv12 needs an even width and height, yuyv an even width. Throws PixelError when the bytes don't
/// suffice; never reads beyond them.
cv::Mat to_rgb(PixelFormat format, int width, int height, std::span<const PixelPlane> planes,
               const YuvCoding& coding = {});

}  // namespace biotomy::bridge
