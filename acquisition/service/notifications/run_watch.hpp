#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/job/job_status.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "acquisition/service/notifications/notice.hpp"

namespace biotomy::acquisition {

struct WatchLimits {
  std::int64_t low_disk_layers = 200;
  double stall_factor = 4.0;  ///< times the usual time of a layer
  std::chrono::milliseconds stall_minimum{120000};
  std::chrono::milliseconds stall_first{3600000};  ///< as long as no pace is known
};

/// Sees from the status, tick by tick, what a person should be told: that a trouble began, that it
/// is over, that the job is done. It only looks; one thread uses it.
class RunWatch {
 public:
  using WallClock = std::function<std::chrono::system_clock::time_point()>;

  /// `interrupted`: what the last daemon was doing when it ended without coming to rest; nothing
  /// when it did.
  RunWatch(const WatchLimits& limits, std::optional<std::string> interrupted, WallClock wall_clock);

  /// What there is to tell since the last look.
  std::vector<Notice> observe(const JobStatus& status, TimePoint now);

 private:
  void watch_interruption(const JobStatus& status);
  void watch_fault(const JobStatus& status);
  void watch_pause(const JobStatus& status);
  void watch_end(const JobStatus& status);
  void watch_disk(const JobStatus& status);
  void watch_pace(const JobStatus& status, TimePoint now);
  std::chrono::milliseconds stall_limit() const;
  void tell(NoticeKind kind, bool over, std::string text);

  WatchLimits limits_;
  std::optional<std::string> interrupted_;
  WallClock wall_clock_;

  const JobStatus* seen_ = nullptr;  ///< the status under observation
  std::vector<Notice> notices_;
  bool first_ = true;
  JobState state_ = JobState::faulted;  ///< at the last look, as what follows
  bool pause_requested_ = false;

  bool interruption_open_ = false;
  std::optional<Alarm> start_alarm_;  ///< the latch of the daemon's start is no trouble
  std::optional<Alarm> fault_;        ///< told and not over
  bool pause_open_ = false;
  bool low_disk_open_ = false;
  bool stall_open_ = false;

  std::optional<TimePoint> pace_from_;  ///< the last layer, or the run's beginning
  bool from_layer_ = false;             ///< `pace_from_` is a layer's end
  std::int64_t committed_ = 0;
  std::deque<std::chrono::milliseconds> layer_times_;
};

}  // namespace biotomy::acquisition
