#include "acquisition/service/notifications/run_watch.hpp"

#include <algorithm>
#include <utility>

#include "acquisition/records/utc_time.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kPaceLayers = 9;

bool is_held(JobState state) {
  return state == JobState::withdrawing || state == JobState::held;
}

/// States in which layers are expected to come one after the other. How long it takes until the
/// block is cold has nothing to do with their pace, and a limit of its own.
bool is_running(JobState state) {
  return !is_at_rest(state) && state != JobState::resetting && state != JobState::pausing &&
         state != JobState::finishing && state != JobState::aborting &&
         state != JobState::conditioning && !is_held(state);
}

bool is_latched(JobState state) {
  return state == JobState::faulted || state == JobState::resetting;
}

bool same(const Alarm& a, const Alarm& b) {
  return a.cause == b.cause && a.since == b.since;
}

std::string duration_text(std::chrono::milliseconds time) {
  const auto seconds = std::chrono::round<std::chrono::seconds>(time).count();
  if (seconds < 120) return std::to_string(seconds) + " s";
  const auto minutes = (seconds + 30) / 60;
  if (minutes < 120) return std::to_string(minutes) + " min";
  return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
}

std::string layers_text(const JobStatus& status) {
  return std::to_string(status.committed) + " of " + std::to_string(status.layers) +
         " layers are stored";
}

}  // namespace

RunWatch::RunWatch(const WatchLimits& limits, std::optional<std::string> interrupted,
                   WallClock wall_clock)
    : limits_(limits), interrupted_(std::move(interrupted)), wall_clock_(std::move(wall_clock)) {}

std::vector<Notice> RunWatch::observe(const JobStatus& status, TimePoint now) {
  seen_ = &status;
  if (first_) {
    start_alarm_ = status.alarm;
    state_ = status.state;
    committed_ = status.committed;
  }
  watch_interruption(status);
  watch_fault(status);
  watch_pause(status);
  watch_end(status);
  watch_disk(status);
  watch_pace(status, now);
  first_ = false;
  state_ = status.state;
  pause_requested_ = status.pause_requested;
  seen_ = nullptr;
  return std::exchange(notices_, {});
}

void RunWatch::watch_interruption(const JobStatus& status) {
  if (first_ && interrupted_) {
    interruption_open_ = true;
    tell(NoticeKind::interrupted, false,
         "the daemon ended while the rig worked (" + *interrupted_ +
             ") and was started again: look at the rig, then acknowledge and start the job, if it "
             "has not gone on by itself");
  }
  if (interruption_open_ && is_running(status.state)) {
    interruption_open_ = false;
    tell(NoticeKind::interrupted, true, "the job goes on after the daemon was started again");
  }
}

void RunWatch::watch_fault(const JobStatus& status) {
  if (is_latched(status.state)) {
    const bool is_trouble = status.alarm &&
                            (!start_alarm_ || !same(*status.alarm, *start_alarm_)) &&
                            (!fault_ || !same(*status.alarm, *fault_));
    if (is_trouble) {
      fault_ = status.alarm;
      tell(NoticeKind::fault, false, "the rig is stopped: " + status.alarm->cause);
    }
  } else if (fault_) {
    tell(NoticeKind::fault, true, "the alarm was acknowledged: " + fault_->cause);
    fault_.reset();
  }
}

void RunWatch::watch_pause(const JobStatus& status) {
  const std::string cause = status.pause_cause.empty() ? "" : ": " + status.pause_cause;
  const bool asked = status.pause_requested || pause_requested_;
  if (is_held(status.state) && !is_held(state_)) {
    pause_open_ = true;
    tell(NoticeKind::pause, false, "the job is held, and goes on by itself when it can" + cause);
  } else if (status.state == JobState::pausing && state_ != JobState::pausing && !asked) {
    pause_open_ = true;
    tell(NoticeKind::pause, false, "the job paused by itself" + cause);
  }
  const bool stands = is_held(status.state) || status.state == JobState::pausing ||
                      status.state == JobState::paused;
  if (pause_open_ && !stands) {
    pause_open_ = false;
    // A fault, or an abort, tells its own story.
    if (is_running(status.state)) tell(NoticeKind::pause, true, "the job goes on after the pause");
  }
}

void RunWatch::watch_end(const JobStatus& status) {
  if (status.state != JobState::done || state_ == JobState::done) return;
  tell(NoticeKind::done, false,
       "the job is done: " + layers_text(status) +
           (status.volume.failure.empty()
                ? ""
                : "; the volume is not complete: " + status.volume.failure));
}

void RunWatch::watch_disk(const JobStatus& status) {
  if (!status.disk_left_layers) return;
  const std::int64_t left = *status.disk_left_layers;
  const std::int64_t to_come = status.layers - status.committed;
  const bool ended = status.state == JobState::done || status.state == JobState::aborted;
  // Once low, a tenth more is asked for, so that a disk at the limit is not told again and again.
  const std::int64_t limit =
      limits_.low_disk_layers + (low_disk_open_ ? limits_.low_disk_layers / 10 + 1 : 0);
  const bool low = !ended && left < limit && left < to_come;
  if (low == low_disk_open_) return;
  low_disk_open_ = low;
  if (low) {
    tell(NoticeKind::low_disk, false,
         "the disk has room for " + std::to_string(left) + " more layers, and " +
             std::to_string(to_come) + " are still to come: make room");
  } else {
    tell(NoticeKind::low_disk, true, "the disk has room for what is still to come");
  }
}

void RunWatch::watch_pace(const JobStatus& status, TimePoint now) {
  const bool stored = status.committed > committed_;
  committed_ = status.committed;
  if (!is_running(status.state)) {
    pace_from_.reset();
    from_layer_ = false;
    stall_open_ = false;  // what stopped the run tells its own story
    return;
  }
  if (!pace_from_) pace_from_ = now;
  const auto since = std::chrono::floor<std::chrono::milliseconds>(now - *pace_from_);
  if (stored) {
    if (from_layer_) {
      layer_times_.push_back(since);
      if (layer_times_.size() > kPaceLayers) layer_times_.pop_front();
    }
    pace_from_ = now;
    from_layer_ = true;
    if (std::exchange(stall_open_, false)) {
      tell(NoticeKind::stalled, true, "a new layer is stored again, after " + duration_text(since));
    }
    return;
  }
  if (stall_open_ || since <= stall_limit()) return;
  stall_open_ = true;
  tell(NoticeKind::stalled, false,
       "no new layer for " + duration_text(since) + ": the job is " + to_string(status.state) +
           (status.waiting_for.empty() ? "" : " and " + status.waiting_for));
}

std::chrono::milliseconds RunWatch::stall_limit() const {
  if (layer_times_.empty()) return limits_.stall_first;
  std::vector<std::chrono::milliseconds> times(layer_times_.begin(), layer_times_.end());
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  const auto by_pace = std::chrono::duration_cast<std::chrono::milliseconds>(
      std::chrono::duration<double, std::milli>(*middle) * limits_.stall_factor);
  return std::max(by_pace, limits_.stall_minimum);
}

void RunWatch::tell(NoticeKind kind, bool over, std::string text) {
  Notice notice;
  notice.kind = kind;
  notice.over = over;
  notice.text = std::move(text);
  notice.at = utc_text(wall_clock_());
  notice.job = seen_->job;
  notice.state = to_string(seen_->state);
  notice.layer = seen_->layer;
  notice.layers = seen_->layers;
  notice.committed = seen_->committed;
  notices_.push_back(std::move(notice));
}

}  // namespace biotomy::acquisition
