#include "firmware_bridge/camera/bayer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "firmware_bridge/wire/transfer.hpp"

namespace biotomy::bridge {

namespace {

constexpr int kWhite = 65535;
constexpr int kLeastSide = 4;  // two repetitions of the pattern: demosaicing looks at neighbours

struct NamedOrder {
  std::string_view name;
  BayerOrder order;
  int demosaic_code;
};

constexpr std::array kOrders{
    NamedOrder{"RGGB", BayerOrder::rggb, cv::COLOR_BayerRGGB2RGB_EA},
    NamedOrder{"GRBG", BayerOrder::grbg, cv::COLOR_BayerGRBG2RGB_EA},
    NamedOrder{"GBRG", BayerOrder::gbrg, cv::COLOR_BayerGBRG2RGB_EA},
    NamedOrder{"BGGR", BayerOrder::bggr, cv::COLOR_BayerBGGR2RGB_EA},
};

const NamedOrder& entry_of(BayerOrder order) {
  return *std::find_if(kOrders.begin(), kOrders.end(),
                       [&](const NamedOrder& entry) { return entry.order == order; });
}

/// Which of R, G beside R, G beside B, B (0 to 3) a pixel of this row and column parity is.
int channel_of(BayerOrder order, int row, int column) {
  const char colour = entry_of(order).name[static_cast<std::size_t>(2 * row + column)];
  if (colour == 'R') return 0;
  if (colour == 'B') return 3;
  const char beside = entry_of(order).name[static_cast<std::size_t>(2 * row + 1 - column)];
  return beside == 'R' ? 1 : 2;
}

/// Of a row, the last group of packed values whole.
std::size_t row_bytes_of(const BayerFormat& format, int width) {
  const auto columns = static_cast<std::size_t>(width);
  if (format.is_packed) return format.bits == 10 ? (columns + 3) / 4 * 5 : (columns + 1) / 2 * 3;
  return format.bits == 8 ? columns : 2 * columns;
}

void unpack_10(const std::uint8_t* bytes, std::uint16_t* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* group = bytes + i / 4 * 5;
    values[i] = static_cast<std::uint16_t>(group[i % 4] << 2 | (group[4] >> 2 * (i % 4) & 3));
  }
}

void unpack_12(const std::uint8_t* bytes, std::uint16_t* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* group = bytes + i / 2 * 3;
    values[i] = static_cast<std::uint16_t>(group[i % 2] << 4 | (group[2] >> 4 * (i % 2) & 15));
  }
}

void unpack_row(const BayerFormat& format, const std::uint8_t* bytes, std::uint16_t* values,
                std::size_t count) {
  if (format.is_packed) {
    (format.bits == 10 ? unpack_10 : unpack_12)(bytes, values, count);
  } else if (format.bits == 8) {
    std::copy_n(bytes, count, values);
  } else {
    std::memcpy(values, bytes, sizeof(std::uint16_t) * count);
  }
}

/// From a sensor's value to 16 bits, black taken off and the gain applied.
std::vector<std::uint16_t> levels_of(const BayerFormat& format, int black, double gain) {
  const int most = (1 << format.bits) - 1;
  const double scale = gain * kWhite / std::max(kWhite - black, 1);
  std::vector<std::uint16_t> levels(static_cast<std::size_t>(most) + 1);
  for (int value = 0; value <= most; ++value) {
    const double light = static_cast<double>(value) * kWhite / most - black;
    levels[static_cast<std::size_t>(value)] =
        static_cast<std::uint16_t>(std::clamp(std::lround(light * scale), 0L, long{kWhite}));
  }
  return levels;
}

void apply_srgb(cv::Mat& image) {
  const std::vector<std::uint16_t>& curve = srgb_tables<std::uint16_t>().value;
  cv::parallel_for_({0, image.rows}, [&](const cv::Range& rows) {
    for (int row = rows.start; row < rows.end; ++row) {
      auto* values = image.ptr<std::uint16_t>(row);
      std::transform(values, values + 3 * static_cast<std::ptrdiff_t>(image.cols), values,
                     [&](std::uint16_t value) { return curve[value]; });
    }
  });
}

bool is_known(const BayerFormat& format) {
  if (format.is_packed) return format.bits == 10 || format.bits == 12;
  return format.bits >= 8 && format.bits <= 16 && format.bits % 2 == 0;
}

void check(const BayerFormat& format, int width, int height, const PixelPlane& plane) {
  if (!is_known(format)) throw PixelError("a raw frame of unknown layout");
  if (width < kLeastSide || height < kLeastSide || width % 2 != 0 || height % 2 != 0) {
    throw PixelError("a raw frame needs an even width and height of at least 4");
  }
  const std::size_t row_bytes = row_bytes_of(format, width);
  const std::size_t needed = static_cast<std::size_t>(height - 1) * plane.stride + row_bytes;
  if (plane.stride < row_bytes || plane.bytes.size() < needed) {
    throw PixelError("a raw frame of " + std::to_string(plane.bytes.size()) +
                     " bytes with rows of " + std::to_string(plane.stride) + " is too short for " +
                     std::to_string(height) + " rows of " + std::to_string(row_bytes) + " bytes");
  }
}

}  // namespace

std::optional<BayerFormat> bayer_format(std::string_view name) {
  constexpr std::string_view kPacked = "_CSI2P";
  if (!name.starts_with('S')) return std::nullopt;
  name.remove_prefix(1);
  BayerFormat format;
  const auto* order = std::find_if(kOrders.begin(), kOrders.end(), [&](const NamedOrder& entry) {
    return name.starts_with(entry.name);
  });
  if (order == kOrders.end()) return std::nullopt;
  format.order = order->order;
  name.remove_prefix(order->name.size());
  format.is_packed = name.ends_with(kPacked);
  if (format.is_packed) name.remove_suffix(kPacked.size());
  for (const int bits : {8, 10, 12, 14, 16}) {
    format.bits = bits;
    if (name == std::to_string(bits) && is_known(format)) return format;
  }
  return std::nullopt;
}

cv::Mat demosaic(const BayerFormat& format, int width, int height, const PixelPlane& plane,
                 const RawColours& colours) {
  check(format, width, height, plane);
  const std::array gains{colours.red_gain, 1.0, 1.0, colours.blue_gain};
  std::array<std::vector<std::uint16_t>, 4> levels;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    levels[i] = levels_of(format, colours.black_levels[i], gains[i]);
  }
  const auto most = static_cast<std::uint16_t>((1 << format.bits) - 1);
  cv::Mat mosaic(height, width, CV_16UC1);
  cv::parallel_for_({0, height}, [&](const cv::Range& rows) {
    for (int row = rows.start; row < rows.end; ++row) {
      auto* values = mosaic.ptr<std::uint16_t>(row);
      unpack_row(format, plane.bytes.data() + static_cast<std::size_t>(row) * plane.stride, values,
                 static_cast<std::size_t>(width));
      const std::array tables{
          &levels[static_cast<std::size_t>(channel_of(format.order, row % 2, 0))],
          &levels[static_cast<std::size_t>(channel_of(format.order, row % 2, 1))]};
      for (int column = 0; column < width; ++column) {
        // Some drivers leave dirt in the bits above the value's.
        values[column] = (*tables[static_cast<std::size_t>(column % 2)])[values[column] & most];
      }
    }
  });
  cv::Mat rgb;
  cv::cvtColor(mosaic, rgb, entry_of(format.order).demosaic_code);
  if (colours.is_srgb) apply_srgb(rgb);
  return rgb;
}

}  // namespace biotomy::bridge
