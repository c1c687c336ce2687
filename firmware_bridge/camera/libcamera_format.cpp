#include "firmware_bridge/camera/libcamera_format.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <libcamera/formats.h>
#include <libcamera/property_ids.h>
#include <libcamera/stream.h>

#include "firmware_bridge/device_error.hpp"

namespace biotomy::bridge {

namespace {

using libcamera::StreamRole;

/// In the order of preference: what loses least first.
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

std::string list_of(const std::vector<libcamera::PixelFormat>& formats) {
  std::string text;
  for (const libcamera::PixelFormat& format : formats) {
    text += (text.empty() ? "" : ", ") + format.toString();
  }
  return text;
}

/// Less is better.
int rank_of(const libcamera::PixelFormat& format) {
  const auto named = std::find_if(kFormats.begin(), kFormats.end(),
                                  [&](const auto& entry) { return entry.first == format; });
  if (named != kFormats.end()) return static_cast<int>(named - kFormats.begin());
  constexpr int kMostBits = 16;
  const BayerFormat raw = *bayer_format(format.toString());
  return static_cast<int>(kFormats.size()) + kMostBits - raw.bits;
}

/// The format asked for, or the best of those that can be read; none if neither is offered.
std::optional<libcamera::PixelFormat> choose_format(
    const std::vector<libcamera::PixelFormat>& offered, const std::string& asked) {
  std::optional<libcamera::PixelFormat> best;
  for (const libcamera::PixelFormat& format : offered) {
    if (!known_format(format) || (!asked.empty() && format.toString() != asked)) continue;
    if (!best || rank_of(format) < rank_of(*best)) best = format;
  }
  return best;
}

std::uint64_t area_of(const libcamera::Size& size) {
  return static_cast<std::uint64_t>(size.width) * size.height;
}

/// The largest by area, from the sizes listed or, where a range is given instead, its end.
libcamera::Size largest_size(const libcamera::StreamFormats& formats,
                             const libcamera::PixelFormat& format) {
  libcamera::Size largest = formats.range(format).max;
  for (const libcamera::Size& size : formats.sizes(format)) {
    if (area_of(size) > area_of(largest)) largest = size;
  }
  return largest;
}

/// Sets the still stream's format and size as asked; false if its role does not offer the format.
bool set_still(libcamera::StreamConfiguration& stream, const LibcameraSettings& settings) {
  const auto format = choose_format(stream.formats().pixelformats(), settings.pixel_format);
  if (!format) return false;
  stream.pixelFormat = *format;
  if (settings.width > 0 && settings.height > 0) {
    stream.size = libcamera::Size(static_cast<unsigned int>(settings.width),
                                  static_cast<unsigned int>(settings.height));
  } else if (const libcamera::Size largest = largest_size(stream.formats(), *format);
             !largest.isNull()) {
    stream.size = largest;
  }
  return true;
}

/// The still stream alone, from the first role that offers what is asked for: some pipelines show
/// raw formats for stills, some in a role of their own.
std::unique_ptr<libcamera::CameraConfiguration> still_configuration(
    libcamera::Camera& camera, const LibcameraSettings& settings, StreamRole& role) {
  std::vector<libcamera::PixelFormat> offered;
  for (const StreamRole candidate : {StreamRole::StillCapture, StreamRole::Raw}) {
    auto configuration = camera.generateConfiguration({candidate});
    if (!configuration || configuration->empty()) continue;
    role = candidate;
    if (set_still(configuration->at(0), settings)) return configuration;
    const auto more = configuration->at(0).formats().pixelformats();
    offered.insert(offered.end(), more.begin(), more.end());
  }
  if (offered.empty()) refuse(camera, "it has no stream for stills");
  refuse(camera, settings.pixel_format.empty()
                     ? "it offers no pixel format that can be read (" + list_of(offered) +
                           "); BGR888, RGB888, YUYV, NV12, MJPEG and raw Bayer formats can"
                     : "pixel format \"" + settings.pixel_format +
                           "\" is not offered or cannot be read; it offers " + list_of(offered));
}

/// The still stream and a viewfinder's; none where the pipeline can't do both as asked.
std::unique_ptr<libcamera::CameraConfiguration> with_viewfinder(
    libcamera::Camera& camera, const LibcameraSettings& settings, StreamRole role,
    const libcamera::StreamConfiguration& still) {
  auto configuration = camera.generateConfiguration({role, StreamRole::Viewfinder});
  if (!configuration || configuration->size() < 2) return nullptr;
  configuration->at(0).pixelFormat = still.pixelFormat;
  configuration->at(0).size = still.size;
  libcamera::StreamConfiguration& small = configuration->at(1);
  const auto format = choose_format(small.formats().pixelformats(), "");
  if (!format) return nullptr;
  small.pixelFormat = *format;
  const auto width = static_cast<unsigned int>(settings.viewfinder_width);
  small.size = libcamera::Size(width, width * still.size.height / still.size.width & ~1U);
  const bool is_as_asked = configuration->validate() != libcamera::CameraConfiguration::Invalid &&
                           configuration->size() == 2 && configuration->at(0).size == still.size &&
                           configuration->at(0).pixelFormat == still.pixelFormat &&
                           known_format(small.pixelFormat);
  return is_as_asked ? std::move(configuration) : nullptr;
}

}  // namespace

std::string model_of(const libcamera::Camera& camera) {
  // A string in older versions of libcamera, a view of one in newer ones.
  const auto model = camera.properties().get(libcamera::properties::Model);
  return model ? std::string(*model) : camera.id();
}

std::optional<FrameFormat> known_format(const libcamera::PixelFormat& format) {
  for (const auto& [known, name] : kFormats) {
    if (known == format) return name;
  }
  if (const auto raw = bayer_format(format.toString())) return *raw;
  return std::nullopt;
}

Transfer transfer_of(const libcamera::PixelFormat& format, bool raw_is_srgb) {
  return bayer_format(format.toString()) && !raw_is_srgb ? Transfer::linear : Transfer::srgb;
}

YuvCoding coding_of(const libcamera::StreamConfiguration& stream) {
  using libcamera::ColorSpace;
  YuvCoding coding;
  if (!stream.colorSpace) return coding;
  if (stream.colorSpace->range == ColorSpace::Range::Full) coding.range = YuvRange::full;
  switch (stream.colorSpace->ycbcrEncoding) {
    case ColorSpace::YcbcrEncoding::Rec709:
      coding.matrix = YuvMatrix::bt709;
      break;
    case ColorSpace::YcbcrEncoding::Rec2020:
      coding.matrix = YuvMatrix::bt2020;
      break;
    case ColorSpace::YcbcrEncoding::None:
    case ColorSpace::YcbcrEncoding::Rec601:
      break;
  }
  return coding;
}

std::unique_ptr<libcamera::CameraConfiguration> choose_configuration(
    libcamera::Camera& camera, const LibcameraSettings& settings) {
  StreamRole role = StreamRole::StillCapture;
  auto configuration = still_configuration(camera, settings, role);
  libcamera::StreamConfiguration& stream = configuration->at(0);
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
  const std::string format = stream.pixelFormat.toString();
  if (!known_format(stream.pixelFormat)) {
    refuse(camera, "it insists on the pixel format " + format + ", which cannot be read");
  }
  if (!settings.pixel_format.empty() && format != settings.pixel_format) {
    refuse(camera, "it insists on the pixel format " + format + " instead of " +
                       settings.pixel_format + "; set that pixel_format, or another size");
  }
  if (settings.viewfinder_width > 0) {
    if (auto both = with_viewfinder(camera, settings, role, stream)) return both;
  }
  return configuration;
}

}  // namespace biotomy::bridge
