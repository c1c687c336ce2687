#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/focus/face_lean.hpp"
#include "acquisition/records/journal_rows.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/micrometres.hpp"

namespace biotomy::acquisition {

/// Where a face was found to be sharp, and by what.
struct FocusRecord {
  std::string actuator;                  ///< "column" or "lens"
  std::string position;                  ///< in the actuator's own unit, for people
  bridge::Micrometres plane{};           ///< the same as focus.start_um takes it
  bridge::Micrometres step{};            ///< of a bracket that suits the curve
  bridge::Micrometres depth_of_field{};  ///< as the curve shows it
  std::optional<FaceLean> lean;          ///< where enough of the face shows detail
  std::vector<FocusRow::Point> points;   ///< every frame that was taken, the confirming one last
  bridge::CameraSettings settings;
  std::string found_at;  ///< ISO 8601, UTC
};

/// Writes `focus.json`. Throws CalibrationError.
void write_focus_record(const std::filesystem::path& folder, const FocusRecord& record);

/// What the record says, and what to do with it, in a sentence.
std::string sentence_of(const FocusRecord& record);

}  // namespace biotomy::acquisition
