#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "firmware_bridge/camera/camera.hpp"

namespace biotomy::bridge {

/// What a camera says of the settings of one frame; not set: it does not say.
struct ToldSettings {
  std::optional<std::chrono::microseconds> exposure{};
  std::optional<double> gain{};
  std::optional<double> red_gain{};
  std::optional<double> blue_gain{};
  std::optional<double> lens_position{};
};

/// Which settings a camera has at all. What it has not cannot be disobeyed, nor waited for.
struct SettingsOffered {
  bool exposure = false;
  bool gain = false;
  bool colour_gains = false;
  bool lens = false;
};

/// How what a frame was taken with differs from what was asked, in words; none when it does not, or
/// the camera does not say. Sensors expose by whole lines and amplify in steps: a tenth of an
/// exposure or of a gain, 100 µs and 0.05 dioptres are no difference.
std::optional<std::string> difference(const CameraSettings& asked, const ToldSettings& told);

/// Whether the camera says of all that it has and was asked for what it did.
bool tells_all(const SettingsOffered& offered, const CameraSettings& asked,
               const ToldSettings& told);

}  // namespace biotomy::bridge
