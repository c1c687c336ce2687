#include "acquisition/service/metrics/run_metrics.hpp"

#include <algorithm>

namespace biotomy::acquisition {
namespace {

/// Of a tick and its lateness, in seconds.
std::vector<double> tick_bounds() {
  return {0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5};
}

/// Of a step, in seconds.
std::vector<double> step_bounds() {
  return {0.01, 0.025, 0.05, 0.1, 0.2, 0.35, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0, 60.0, 300.0};
}

}  // namespace

RunMetrics::RunMetrics(std::chrono::milliseconds tick_period)
    : tick_period_(tick_period), lateness_(tick_bounds()), tick_times_(tick_bounds()) {}

void RunMetrics::observe(const JobStatus& status, TimePoint began, TimePoint ended) {
  const std::scoped_lock lock(mutex_);
  if (last_tick_) {
    const std::chrono::duration<double> late = began - *last_tick_ - tick_period_;
    lateness_.add(std::max(late, std::chrono::duration<double>(0)));
  }
  last_tick_ = began;
  tick_times_.add(ended - began);
  count_step(status, began);
  count_alarm(status);
  count_attempt(status);
}

void RunMetrics::count_step(const JobStatus& status, TimePoint now) {
  if (state_ == status.state) return;
  if (state_ && !is_at_rest(*state_)) {
    steps_.try_emplace(*state_, step_bounds()).first->second.add(now - state_since_);
  }
  state_ = status.state;
  state_since_ = now;
}

void RunMetrics::count_alarm(const JobStatus& status) {
  if (!status.alarm) return;
  // The latch that the daemon starts with is the first that is seen, and no alarm.
  if (!alarm_since_.empty() && alarm_since_ != status.alarm->since) ++alarms_;
  alarm_since_ = status.alarm->since;
}

void RunMetrics::count_attempt(const JobStatus& status) {
  if (!status.last_attempt || status.last_attempt == attempt_) return;
  attempt_ = status.last_attempt;
  ++attempts_[{to_string(attempt_->verdict), attempt_->slug}];
}

std::vector<MetricFamily> RunMetrics::families() const {
  using enum MetricType;
  const std::scoped_lock lock(mutex_);
  MetricFamily attempts{"biotomy_attempts_total", counter,
                        "Frames that were judged, by verdict and reason."};
  for (const auto& [key, count] : attempts_) {
    attempts.samples.push_back(
        {{{"verdict", key.first}, {"reason", key.second}}, static_cast<double>(count)});
  }
  MetricFamily steps{
      "biotomy_step_duration_seconds", histogram,
      "How long the job was in a state, by step; that of storing is the store time."};
  for (const auto& [state, times] : steps_) {
    steps.histograms.push_back(times.sample({{"step", to_string(state)}}));
  }
  return {
      std::move(attempts),
      {"biotomy_alarms_total",
       counter,
       "Alarms that stopped the rig.",
       {{{}, static_cast<double>(alarms_)}}},
      std::move(steps),
      {"biotomy_tick_lateness_seconds",
       histogram,
       "How much later than planned a tick of the control loop began.",
       {},
       {lateness_.sample({})}},
      {"biotomy_tick_duration_seconds",
       histogram,
       "How long a tick of the control loop took.",
       {},
       {tick_times_.sample({})}},
  };
}

}  // namespace biotomy::acquisition
