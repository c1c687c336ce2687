#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "acquisition/calibration/calibration_plan.hpp"
#include "acquisition/calibration/mean_frame.hpp"
#include "acquisition/job/job_plan.hpp"
#include "acquisition/job/step_failure.hpp"
#include "acquisition/job/worker.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/lines/lines.hpp"

namespace biotomy::acquisition {

enum class CalibrationKind { flat, dark, white };

const char* to_string(CalibrationKind kind);

/// What a calibration run works with. All outlive it; the camera belongs to the worker's thread.
struct CalibrationParts {
  bridge::Camera& camera;  ///< whose frames nobody has corrected
  bridge::Lines& lines;
  Worker& worker;
};

/// Records one calibration while the rig is at rest: switches the lamp as the kind needs it, waits
/// for it to be warm, photographs the frames, judges them and writes what is found. Moved on by
/// `poll`, which does not block.
class CalibrationRun {
 public:
  CalibrationRun(CalibrationKind kind, const CalibrationPlan& plan, const CameraPlan& camera,
                 std::chrono::milliseconds lamp_warm_up, const CalibrationParts& parts,
                 std::function<std::string()> utc_now, TimePoint now);

  /// Once all is done, what was found, in a sentence. Throws what hinders it: CalibrationError,
  /// DeviceError.
  std::optional<std::string> poll(TimePoint now);

  CalibrationKind kind() const { return kind_; }
  int taken() const { return taken_; }  ///< frames

 private:
  void ask_frame();
  void ask_record();

  CalibrationKind kind_;
  CalibrationPlan plan_;
  CameraPlan camera_;
  std::chrono::milliseconds lamp_warm_up_;
  CalibrationParts parts_;
  std::function<std::string()> utc_now_;
  TimePoint begun_;
  int taken_ = 0;
  std::shared_ptr<MeanFrame> frames_ = std::make_shared<MeanFrame>();
  std::future<void> frame_;
  std::future<std::string> record_;
};

}  // namespace biotomy::acquisition
