#pragma once

#include <optional>
#include <string>

#include "acquisition/rig/step_failure.hpp"
#include "acquisition/settings/safety_limits.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Waits until the block has been in its window of temperature for `temperature_delay`, and watches
/// that it gets there: a cooler that does not cool is a fault long before the wait's limit.
class Conditioning {
 public:
  explicit Conditioning(const SafetyLimits& limits);

  void begin(TimePoint now);

  /// True when the block is ready. Throws StepFailure when it does not come nearer to its window.
  bool poll(const bridge::StageStatus& status, TimePoint now);

  std::string waiting_for() const;

 private:
  /// How far the block is from its window, in kelvin; 0 inside.
  double distance(double block_c) const;

  SafetyLimits limits_;
  double block_c_ = 0.0;
  std::optional<TimePoint> inside_since_;
  std::optional<double> nearest_;  ///< the least distance that counted as progress
  TimePoint progress_at_{};
};

}  // namespace biotomy::acquisition
