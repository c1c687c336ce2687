#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "firmware_bridge/camera/camera.hpp"

namespace biotomy::acquisition {

/// How frames were taken, as the records of calibrations tell it.
nlohmann::ordered_json taken_with(const bridge::CameraSettings& settings);

/// Writes the record `name` into the folder, which is made if need be. Until it is on the disk, the
/// one that was there before is whole. Throws CalibrationError.
void write_calibration_file(const std::filesystem::path& folder, const std::string& name,
                            const nlohmann::ordered_json& record);

}  // namespace biotomy::acquisition
