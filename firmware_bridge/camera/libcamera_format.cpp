#include "firmware_bridge/camera/libcamera_format.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <libcamera/formats.h>
#include <libcamera/stream.h>

#include "firmware_bridge/device_error.hpp"

namespace biotomy::bridge {

namespace {

/// In the order of preference: no loss first, a film's compression last.
const std::array kFormats{
    std::pair{libcamera::formats::BGR888, PixelFormat::rgb24},
    std::pair{libcamera::formats::RGB888, PixelFormat::bgr24},
    std::pair{libcamera::formats::YUYV, PixelFormat::yuyv},
    std::pair{libcamera::formats::NV12, PixelFormat::nv12},
    std::pair{libcamera::formats::MJPEG, PixelFormat::mjpeg},
};

[[noreturn]] void refuse(const libcamera::Camera& camera, const std::string& what) {
  throw DeviceError(DeviceError::Kind::configuration, "camera " + camera.id() + ": " + what);
}

bool contains(const std::vector<libcamera::PixelFormat>& formats,
              const libcamera::PixelFormat& format) {
  return std::find(formats.begin(), formats.end(), format) != formats.end();
}

std::string list_of(const std::vector<libcamera::PixelFormat>& formats) {
  std::string text;
  for (const libcamera::PixelFormat& format : formats) {
    text += (text.empty() ? "" : ", ") + format.toString();
  }
  return text;
}

libcamera::PixelFormat choose_format(const libcamera::Camera& camera,
                                     const std::vector<libcamera::PixelFormat>& offered,
                                     const std::string& asked) {
  for (const auto& [format, name] : kFormats) {
    const bool is_wanted = asked.empty() || format.toString() == asked;
    if (is_wanted && contains(offered, format)) return format;
  }
  refuse(camera, asked.empty() ? "it offers no pixel format that can be read (" + list_of(offered) +
                                     "); BGR888, RGB888, YUYV, NV12 and MJPEG can"
                               : "pixel format \"" + asked +
                                     "\" is not offered or cannot be "
                                     "read; it offers " +
                                     list_of(offered));
}

/// The largest by area, from the sizes listed or, where a range is given instead, its end.
libcamera::Size largest_size(const libcamera::StreamFormats& formats,
                             const libcamera::PixelFormat& format) {
  libcamera::Size largest = formats.range(format).max;
  const auto area = [](const libcamera::Size& size) {
    return static_cast<std::uint64_t>(size.width) * size.height;
  };
  for (const libcamera::Size& size : formats.sizes(format)) {
    if (area(size) > area(largest)) largest = size;
  }
  return largest;
}

}  // namespace

std::optional<PixelFormat> known_format(const libcamera::PixelFormat& format) {
  for (const auto& [known, name] : kFormats) {
    if (known == format) return name;
  }
  return std::nullopt;
}

YuvRange range_of(const libcamera::StreamConfiguration& stream) {
  const bool is_full = stream.colorSpace.has_value() &&
                       stream.colorSpace->range == libcamera::ColorSpace::Range::Full;
  return is_full ? YuvRange::full : YuvRange::limited;
}

std::unique_ptr<libcamera::CameraConfiguration> choose_configuration(
    libcamera::Camera& camera, const LibcameraSettings& settings) {
  auto configuration = camera.generateConfiguration({libcamera::StreamRole::StillCapture});
  if (!configuration || configuration->empty()) refuse(camera, "it has no stream for stills");

  libcamera::StreamConfiguration& stream = configuration->at(0);
  const std::vector<libcamera::PixelFormat> offered = stream.formats().pixelformats();
  stream.pixelFormat = choose_format(camera, offered, settings.pixel_format);
  if (settings.width > 0 && settings.height > 0) {
    stream.size = libcamera::Size(static_cast<unsigned int>(settings.width),
                                  static_cast<unsigned int>(settings.height));
  } else if (const libcamera::Size largest = largest_size(stream.formats(), stream.pixelFormat);
             !largest.isNull()) {
    stream.size = largest;
  }

  const libcamera::Size asked = stream.size;
  if (configuration->validate() == libcamera::CameraConfiguration::Invalid) {
    refuse(camera, "it cannot be configured for stills");
  }
  // validate() changes what it can't do to what it can. A size that the operator wrote down is
  // part of the sample's geometry and must not change quietly.
  if (settings.width > 0 && settings.height > 0 && stream.size != asked) {
    refuse(camera, "it offers " + stream.size.toString() + " instead of " + asked.toString() +
                       "; set that width and height");
  }
  if (!known_format(stream.pixelFormat)) {
    refuse(camera, "it insists on the pixel format " + stream.pixelFormat.toString() +
                       ", which cannot be read");
  }
  return configuration;
}

}  // namespace biotomy::bridge
