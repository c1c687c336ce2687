#pragma once

#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>

#include "acquisition/rig/alarm_kind.hpp"

namespace biotomy::acquisition {

/// A moment of the clock that the control thread lives by.
using TimePoint = std::chrono::steady_clock::time_point;

/// A step that cannot be finished: the job faults, and the message is the alarm's cause.
class StepFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  StepFailure(const std::string& cause, AlarmKind kind) : std::runtime_error(cause), kind_(kind) {}

  /// What it is about; nothing when the step itself tells.
  std::optional<AlarmKind> kind() const { return kind_; }

 private:
  std::optional<AlarmKind> kind_;
};

/// There is not enough room on the disk for the layers to come.
class DiskFull : public StepFailure {
 public:
  explicit DiskFull(const std::string& cause) : StepFailure(cause, AlarmKind::disk) {}
};

}  // namespace biotomy::acquisition
