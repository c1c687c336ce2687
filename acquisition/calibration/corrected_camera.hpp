#pragma once

#include <memory>
#include <optional>
#include <string>

#include "acquisition/calibration/field_correction.hpp"
#include "acquisition/settings/calibration_plan.hpp"
#include "firmware_bridge/camera/camera.hpp"

namespace biotomy::acquisition {

/// A camera whose frames are corrected by the calibrations of a folder before anybody sees them:
/// the focus search, the assessment and the store have the same picture.
class CorrectedCamera : public bridge::Camera {
 public:
  /// `camera` outlives it.
  CorrectedCamera(bridge::Camera& camera, CalibrationPlan plan);

  /// With the calibrations in force, once settings were applied.
  bridge::CameraDescription describe() override;

  /// Reads the calibrations anew, but where only the lens is moved. Throws CalibrationError when
  /// one is missing or damaged, or was recorded at another size or with other settings.
  void apply(const bridge::CameraSettings& settings) override;

  /// Throws CalibrationError when the frame is not of the calibrations' bits.
  bridge::Frame capture(std::chrono::milliseconds time_out) override;

 private:
  bridge::Camera& camera_;
  CalibrationPlan plan_;
  std::optional<bridge::CameraSettings> applied_;  ///< without the lens
  std::unique_ptr<FieldCorrection> correction_;
  int bits_ = 8;
  std::string in_force_;
};

}  // namespace biotomy::acquisition
