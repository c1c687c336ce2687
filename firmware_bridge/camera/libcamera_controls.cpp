#include "firmware_bridge/camera/libcamera_controls.hpp"

#include <algorithm>
#include <array>
#include <sstream>

#include "firmware_bridge/camera/libcamera_compat.hpp"

namespace biotomy::bridge {

namespace {

namespace id = libcamera::controls;

template <typename Value>
std::optional<std::string> outside(const char* what, Value value, Value least, Value most) {
  if (value >= least && value <= most) return std::nullopt;
  std::ostringstream text;
  text << what << " of " << value << "; it can do " << least << " to " << most;
  return text.str();
}

}  // namespace

SettingsOffered settings_offered(const libcamera::ControlInfoMap& offered) {
  return {.exposure = has_control(offered, id::EXPOSURE_TIME),
          .gain = has_control(offered, id::ANALOGUE_GAIN),
          .colour_gains = has_control(offered, id::COLOUR_GAINS),
          .lens = has_control(offered, id::LENS_POSITION)};
}

std::optional<LensRange> lens_range(const libcamera::ControlInfoMap& offered) {
  const auto lens = offered.find(id::LENS_POSITION);
  if (lens == offered.end()) return std::nullopt;
  return LensRange{.farthest = static_cast<double>(lens->second.min().get<float>()),
                   .nearest = static_cast<double>(lens->second.max().get<float>())};
}

std::optional<std::string> settings_complaint(const libcamera::ControlInfoMap& offered,
                                              const CameraSettings& settings) {
  if (const auto range = offered.find(id::EXPOSURE_TIME); range != offered.end()) {
    const auto least = range->second.min().get<std::int32_t>();
    const auto most = range->second.max().get<std::int32_t>();
    if (auto text =
            outside<std::int64_t>("an exposure in us", settings.exposure.count(), least, most)) {
      return text;
    }
  }
  if (const auto range = offered.find(id::ANALOGUE_GAIN); range != offered.end()) {
    const auto least = static_cast<double>(range->second.min().get<float>());
    const auto most = static_cast<double>(range->second.max().get<float>());
    if (auto text = outside("a gain", settings.gain, least, most)) return text;
  }
  if (!settings.lens_position) return std::nullopt;
  const std::optional<LensRange> lens = lens_range(offered);
  if (!lens) return "it has no lens that can be driven";
  return outside("a lens position in dioptres", *settings.lens_position, lens->farthest,
                 lens->nearest);
}

void write_settings(const libcamera::ControlInfoMap& offered, const CameraSettings& settings,
                    libcamera::ControlList& controls) {
  set_manual_exposure(offered, controls);
  if (has_control(offered, id::AWB_ENABLE)) controls.set(id::AwbEnable, false);
  if (has_control(offered, id::EXPOSURE_TIME)) {
    controls.set(id::ExposureTime, static_cast<std::int32_t>(settings.exposure.count()));
  }
  if (has_control(offered, id::ANALOGUE_GAIN)) {
    controls.set(id::AnalogueGain, static_cast<float>(settings.gain));
  }
  if (has_control(offered, id::COLOUR_GAINS)) {
    const std::array gains{static_cast<float>(settings.red_gain),
                           static_cast<float>(settings.blue_gain)};
    controls.set(id::ColourGains, libcamera::Span<const float, 2>(gains));
  }
  if (settings.lens_position) {
    if (has_control(offered, id::AF_MODE)) controls.set(id::AfMode, id::AfModeManual);
    controls.set(id::LensPosition, static_cast<float>(*settings.lens_position));
  }
}

ToldSettings told_settings(const libcamera::ControlList& metadata) {
  ToldSettings told;
  if (const auto exposure = metadata.get(id::ExposureTime)) {
    told.exposure = std::chrono::microseconds(*exposure);
  }
  if (const auto gain = metadata.get(id::AnalogueGain)) told.gain = static_cast<double>(*gain);
  if (const auto gains = metadata.get(id::ColourGains)) {
    told.red_gain = static_cast<double>((*gains)[0]);
    told.blue_gain = static_cast<double>((*gains)[1]);
  }
  if (const auto lens = metadata.get(id::LensPosition)) {
    told.lens_position = static_cast<double>(*lens);
  }
  return told;
}

RawColours raw_colours(const libcamera::ControlList& metadata,
                       const std::optional<CameraSettings>& settings, bool is_srgb) {
  RawColours colours{.is_srgb = is_srgb};
  if (const auto levels = metadata.get(id::SensorBlackLevels)) {
    std::copy(levels->begin(), levels->end(), colours.black_levels.begin());
  }
  if (settings) {
    colours.red_gain = settings->red_gain;
    colours.blue_gain = settings->blue_gain;
  }
  return colours;
}

}  // namespace biotomy::bridge
