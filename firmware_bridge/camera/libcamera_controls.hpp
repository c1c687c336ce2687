#pragma once

#include <optional>
#include <string>

#include <libcamera/controls.h>

#include "firmware_bridge/camera/bayer.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/camera/told_settings.hpp"

namespace biotomy::bridge {

/// Which of our settings a camera has controls for.
SettingsOffered settings_offered(const libcamera::ControlInfoMap& offered);

/// How far it can drive its lens; none when it has none that can be driven.
std::optional<LensRange> lens_range(const libcamera::ControlInfoMap& offered);

/// Why it cannot follow the settings, in words; none when it can, or has no such control.
std::optional<std::string> settings_complaint(const libcamera::ControlInfoMap& offered,
                                              const CameraSettings& settings);

/// The settings as controls, as far as the camera has them, with its automatic modes off.
void write_settings(const libcamera::ControlInfoMap& offered, const CameraSettings& settings,
                    libcamera::ControlList& controls);

/// What a frame's metadata say of the settings it was taken with.
ToldSettings told_settings(const libcamera::ControlList& metadata);

/// What is to be done to a raw frame with this metadata. White balance is ours to apply: raw values
/// come from before the camera's own.
RawColours raw_colours(const libcamera::ControlList& metadata,
                       const std::optional<CameraSettings>& settings, bool is_srgb);

}  // namespace biotomy::bridge
