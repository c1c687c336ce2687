#pragma once

#include <filesystem>
#include <string>

#include "acquisition/calibration/mean_frame.hpp"
#include "firmware_bridge/camera/camera.hpp"

namespace biotomy::acquisition {

/// Gains of red and blue; green's is 1.
struct WhiteBalance {
  double red_gain = 1.0;
  double blue_gain = 1.0;
};

/// The gains that make the middle half of the frames as red and as blue as it is green, when they
/// were taken with the gains given, which act on the light: that half is of a neutral grey and has
/// all three colours.
WhiteBalance white_balance(const MeanFrame& frames, const WhiteBalance& in_force);

/// Writes `white.json`: what was found, and how the frames were taken. Throws CalibrationError.
void write_white_balance(const std::filesystem::path& folder, const WhiteBalance& balance,
                         const bridge::CameraSettings& settings, const std::string& taken_at);

}  // namespace biotomy::acquisition
