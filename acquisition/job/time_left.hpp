#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "acquisition/rig/step_failure.hpp"

namespace biotomy::acquisition {

/// How long the layers to come may take, from how long those took that this run has made.
class TimeLeft {
 public:
  /// In seconds.
  struct Range {
    double low = 0.0;
    double high = 0.0;
  };

  /// The run's first layer is begun, or the first after a pause.
  void begin(TimePoint now);

  void layer_done(TimePoint now);

  /// The time until the next layer is done is no layer's own.
  void interrupted() { last_done_.reset(); }

  /// The run is over, or pauses: there is no estimate until the next one has made a layer.
  void end();

  /// In seconds, were they to take as long as those of this run in the mean; nothing before the
  /// first.
  std::optional<double> estimate(std::int64_t layers) const;

  /// Within which about nineteen of twenty runs end, were layers to go on as the last twenty did;
  /// it holds the estimate. Nothing before five layers, or without an estimate.
  std::optional<Range> range(std::int64_t layers) const;

 private:
  std::optional<TimePoint> began_;
  std::int64_t made_ = 0;  ///< since then
  TimePoint newest_{};     ///< when the last of these was done
  std::optional<TimePoint> last_done_;
  std::deque<double> durations_;  ///< in seconds, also of earlier runs
};

}  // namespace biotomy::acquisition
