#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "firmware_bridge/camera/pixel_formats.hpp"

namespace biotomy::bridge {

/// The colours of a sensor's first two rows, from the left: "rggb" is R G over G B.
enum class BayerOrder { rggb, grbg, gbrg, bggr };

/// How a sensor's raw values lie in memory.
struct BayerFormat {
  BayerOrder order = BayerOrder::rggb;
  int bits = 8;  ///< of a value: 8, 10, 12, 14 or 16
  /// As MIPI CSI-2 sends them (specification 2.1, sections 11.4.3 and 11.4.4: RAW10 puts four
  /// values into five bytes, RAW12 two into three, the low bits last). Otherwise values of more
  /// than 8 bits are 16-bit little-endian numbers with the value in their low bits.
  bool is_packed = false;

  friend bool operator==(const BayerFormat&, const BayerFormat&) = default;
};

/// From libcamera's name for it, "SRGGB8", "SGRBG10", "SBGGR12_CSI2P" …; none for a name of
/// anything else.
std::optional<BayerFormat> bayer_format(std::string_view name);

/// What a camera's own image processor would do to raw values.
struct RawColours {
  /// Of R, the G beside R, the G beside B, and B, of 65535: what the sensor gives in the dark.
  std::array<int, 4> black_levels{};
  double red_gain = 1.0;  ///< white balance; green is 1
  double blue_gain = 1.0;
  /// Apply the curve of sRGB (IEC 61966-2-1), which every viewer expects; otherwise values stay in
  /// proportion to the light.
  bool is_srgb = true;
};

/// Demosaics a raw frame (edge-aware, OpenCV) to height × width CV_16UC3 in the order R, G, B, over
/// the full range of 16 bits: black taken off, the white of the sensor kept at 65535 by clipping
/// what the gains raise above it. Colours are the sensor's own primaries. Width and height must be
/// even. Throws PixelError when the bytes don't suffice; never reads beyond them.
cv::Mat demosaic(const BayerFormat& format, int width, int height, const PixelPlane& plane,
                 const RawColours& colours);

}  // namespace biotomy::bridge
