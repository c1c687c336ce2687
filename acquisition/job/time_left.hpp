#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "acquisition/rig/step_failure.hpp"

namespace biotomy::acquisition {

/// How long the layers to come may take, from how long the last ones took.
class TimeLeft {
 public:
  /// In seconds.
  struct Range {
    double low = 0.0;
    double high = 0.0;
  };

  void layer_done(TimePoint now);

  /// The time until the next layer is done is no layer's own.
  void interrupted() { last_done_.reset(); }

  /// Within which about nineteen of twenty runs end, were layers to go on as the last twenty did;
  /// it holds `estimate`, in seconds. Nothing before five layers, or without an estimate.
  std::optional<Range> of(std::int64_t layers, std::optional<double> estimate) const;

 private:
  std::optional<TimePoint> last_done_;
  std::deque<double> durations_;  ///< in seconds
};

}  // namespace biotomy::acquisition
