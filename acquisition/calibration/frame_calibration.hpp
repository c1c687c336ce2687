#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "acquisition/calibration/calibration_run.hpp"
#include "acquisition/calibration/mean_frame.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "acquisition/settings/calibration_plan.hpp"
#include "acquisition/settings/job_plan.hpp"
#include "acquisition/worker.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/lines/lines.hpp"

namespace biotomy::acquisition {

/// What frames are taken for.
enum class CalibrationKind { flat, dark, white };

const char* to_string(CalibrationKind kind);

/// What a calibration by frames works with. All outlive it; the camera belongs to the worker's
/// thread.
struct FrameCalibrationParts {
  bridge::Camera& camera;  ///< whose frames nobody has corrected
  bridge::Lines& lines;
  Worker& worker;
};

/// Records what the mean of several frames shows: switches the lamp as the kind needs it, waits for
/// it to be warm, photographs the frames, judges them and writes what is found.
class FrameCalibration : public CalibrationRun {
 public:
  FrameCalibration(CalibrationKind kind, const CalibrationPlan& plan, const CameraPlan& camera,
                   std::chrono::milliseconds lamp_warm_up, const FrameCalibrationParts& parts,
                   std::function<std::string()> utc_now, TimePoint now);

  std::optional<std::string> poll(const std::optional<bridge::StageStatus>& status,
                                  TimePoint now) override;
  std::string progress() const override;
  bool moves_axes() const override { return false; }

 private:
  void ask_frame();
  void ask_record();

  CalibrationKind kind_;
  CalibrationPlan plan_;
  CameraPlan camera_;
  std::chrono::milliseconds lamp_warm_up_;
  FrameCalibrationParts parts_;
  std::function<std::string()> utc_now_;
  TimePoint begun_;
  int taken_ = 0;
  /// The first frame's camera tells how its values follow the light.
  std::shared_ptr<MeanFrame> frames_ = std::make_shared<MeanFrame>(bridge::Transfer::srgb);
  std::future<void> frame_;
  std::future<std::string> record_;
};

}  // namespace biotomy::acquisition
