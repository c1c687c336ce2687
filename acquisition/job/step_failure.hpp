#pragma once

#include <chrono>
#include <stdexcept>

namespace biotomy::acquisition {

/// A moment of the clock that the control thread lives by.
using TimePoint = std::chrono::steady_clock::time_point;

/// A step that cannot be finished: the job faults, and the message is the alarm's cause.
class StepFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// There is not enough room on the disk for the layers to come.
class DiskFull : public StepFailure {
 public:
  using StepFailure::StepFailure;
};

}  // namespace biotomy::acquisition
