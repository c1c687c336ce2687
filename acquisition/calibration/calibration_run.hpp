#pragma once

#include <optional>
#include <string>

#include "acquisition/rig/step_failure.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// A calibration of a rig that is at rest, under way. Moved on by `poll`, which does not block.
class CalibrationRun {
 public:
  virtual ~CalibrationRun() = default;

  /// `status` is of this tick; nothing when the controller did not answer. Once all is done, what
  /// was found, in a sentence. Throws what hinders it: CalibrationError, DeviceError, StepFailure.
  virtual std::optional<std::string> poll(const std::optional<bridge::StageStatus>& status,
                                          TimePoint now) = 0;

  /// How far it is, in words.
  virtual std::string progress() const = 0;

  /// True from the first command to the stage on: the rig must be watched as while a job moves it,
  /// and the stage must be stopped when the calibration ends before its end.
  virtual bool moves_axes() const = 0;
};

}  // namespace biotomy::acquisition
