#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "acquisition/rig/step_failure.hpp"
#include "acquisition/settings/safety_limits.hpp"

namespace biotomy::acquisition {

/// Waits until the computer's clock can be right: that of a board without a battery is behind until
/// the network has set it.
class ClockWait {
 public:
  explicit ClockWait(const SafetyLimits& limits);

  void begin();

  /// The journal's last record is of `record_at`, as in JournalSummary, which lies ahead of the
  /// clock.
  void is_behind(const std::string& record_at);

  /// True while nothing speaks against the clock. Throws StepFailure when it is not set within
  /// `preflight_limit`.
  bool poll(std::chrono::system_clock::time_point clock, TimePoint now);

  /// Empty when it waits for nothing.
  const std::string& waiting_for() const { return waiting_for_; }

  /// The record that lay ahead when the wait was given up: whoever acknowledged that alarm has said
  /// that it is wrong, and not the clock. Empty if there was none.
  const std::string& wrong_record() const { return wrong_record_; }

 private:
  SafetyLimits limits_;
  std::string record_at_;
  std::string wrong_record_;
  std::string waiting_for_;
  std::optional<TimePoint> began_;
};

}  // namespace biotomy::acquisition
