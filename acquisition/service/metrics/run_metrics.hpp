#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "acquisition/job/job_status.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "acquisition/service/metrics/duration_histogram.hpp"
#include "acquisition/service/metrics/metric_family.hpp"

namespace biotomy::acquisition {

/// What the run looks like to Prometheus. The control thread shows it every tick's status; any
/// thread asks for the families. Counters begin at zero with the daemon.
class RunMetrics {
 public:
  explicit RunMetrics(std::chrono::milliseconds tick_period);

  /// `began` and `ended` are the tick's own times.
  void observe(const JobStatus& status, TimePoint began, TimePoint ended);

  /// Always the same families in the same order.
  std::vector<MetricFamily> families() const;

 private:
  void count_step(const JobStatus& status, TimePoint now);
  void count_alarm(const JobStatus& status);
  void count_attempt(const JobStatus& status);

  std::chrono::milliseconds tick_period_;

  mutable std::mutex mutex_;
  std::optional<TimePoint> last_tick_;
  DurationHistogram lateness_;
  DurationHistogram tick_times_;
  std::optional<JobState> state_;
  TimePoint state_since_{};
  std::map<JobState, DurationHistogram> steps_;
  std::string alarm_since_;
  std::uint64_t alarms_ = 0;
  std::optional<JudgedAttempt> attempt_;
  std::map<std::pair<std::string, std::string>, std::uint64_t> attempts_;  ///< verdict, reason
};

}  // namespace biotomy::acquisition
