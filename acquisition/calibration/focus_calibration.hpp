#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "acquisition/calibration/calibration_run.hpp"
#include "acquisition/focus/focus_actuator.hpp"
#include "acquisition/rig/focus_search.hpp"
#include "acquisition/rig/homing_step.hpp"
#include "acquisition/rig/parking.hpp"
#include "acquisition/rig/stage_commands.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "acquisition/settings/job_settings.hpp"
#include "acquisition/worker.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/lines/lines.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// What a calibration of the focus works with. All outlive it; the camera, which is the job's own,
/// belongs to the worker's thread.
struct FocusCalibrationParts {
  bridge::Stage& stage;
  StageCommands& commands;
  bridge::Lines& lines;
  bridge::Camera& camera;
  Worker& worker;
};

/// Why the focus cannot be calibrated by a stage in this state; nothing when it can.
std::optional<std::string> focus_calibration_complaint(const bridge::StageStatus& status,
                                                       const SafetyLimits& limits);

/// Finds where the face under the camera is sharp: homes the axes if need be, parks the block, puts
/// the lamp on, searches by column or lens as a job does, and writes `focus.json`. The actuator
/// stays where the face is sharp. When no focus is found, a column goes back to where it stood, so
/// that the next attempt begins alike.
///
/// While it moves axes the caller watches the rig and stops it, as while a job does.
class FocusCalibration : public CalibrationRun {
 public:
  /// `settings` outlive it.
  FocusCalibration(const JobSettings& settings, const FocusCalibrationParts& parts,
                   std::function<std::string()> utc_now, TimePoint now);

  /// Throws StepFailure, beside the rest, when a step takes too long, the wheel spins or the axes
  /// lost their reference.
  std::optional<std::string> poll(const std::optional<bridge::StageStatus>& status,
                                  TimePoint now) override;

  std::string progress() const override;
  bool moves_axes() const override { return phase_ != Phase::asking; }

 private:
  enum class Phase { asking, homing, parking, lighting, searching, going_back, recording };

  void go(Phase phase, TimePoint now);
  std::optional<std::chrono::milliseconds> limit() const;
  void poll_step(const bridge::StageStatus& status, TimePoint now);
  void poll_asking(const bridge::StageStatus& status, TimePoint now);
  void begin_search(const bridge::StageStatus& status, TimePoint now);
  void poll_search(const bridge::StageStatus& status, TimePoint now);
  void begin_recording(const Autofocus::Found& found);
  std::string why_not_found() const;

  const JobSettings& settings_;
  FocusCalibrationParts parts_;
  std::function<std::string()> utc_now_;
  HomingStep homing_;
  Parking parking_;
  Phase phase_ = Phase::asking;
  TimePoint begun_;  ///< the phase
  std::optional<bridge::StageIdentity> identity_;
  std::future<bridge::CameraDescription> camera_;
  std::unique_ptr<FocusActuator> actuator_;
  bool was_homed_ = false;
  bridge::Micrometres column_stood_at_{};
  std::optional<FocusSearch> search_;
  std::future<std::string> record_;
};

}  // namespace biotomy::acquisition
