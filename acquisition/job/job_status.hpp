#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/job/focus_report.hpp"
#include "acquisition/job/job_states.hpp"
#include "acquisition/job/judged_attempt.hpp"
#include "acquisition/job/layer_cycle.hpp"
#include "acquisition/job/operator_desk.hpp"
#include "acquisition/job/time_left.hpp"
#include "acquisition/records/volume_feed.hpp"
#include "acquisition/rig/alarm_kind.hpp"
#include "firmware_bridge/lines/lines.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

struct Alarm {
  std::string cause;
  std::string since;                   ///< ISO 8601, UTC
  JobState state = JobState::faulted;  ///< in which it came; `faulted`: it is the start's latch
  AlarmKind kind = AlarmKind::start_latch;
};

/// What has become of the last calibration that was asked for.
struct CalibrationStatus {
  std::string kind;  ///< "flat", "dark", "white", "focus"; empty before the first
  enum class Progress { running, done, failed } progress = Progress::done;
  std::string sentence;  ///< how far it is, what was found, or why it failed
};

/// What the daemon shows of itself: a snapshot of one tick.
struct JobStatus {
  JobState state = JobState::faulted;
  std::string waiting_for;  ///< what the step waits for, in words
  bool pause_requested = false;
  std::string pause_cause;  ///< why the job paused, or is held, by itself; else empty
  std::string job;
  std::string sample;
  std::int64_t layers = 0;     ///< of the whole job
  std::int64_t layer = 0;      ///< in work; 0 when none is
  std::int64_t committed = 0;  ///< layers that are safe
  int attempt = 0;
  std::optional<double> seconds_left;  ///< estimate
  std::optional<TimeLeft::Range> seconds_left_range;
  std::vector<OperatorCommand> commands;  ///< that the job would obey now
  bool controller_answers = false;
  std::optional<bridge::StageStatus> stage;  ///< the last that was read
  bridge::SafetyInputs lines;
  std::optional<JudgedAttempt> last_attempt;
  std::optional<CommittedLayer> last_layer;
  std::optional<FocusReport> focus;  ///< the last search of this run
  std::optional<std::int64_t> disk_left_layers;
  std::optional<Alarm> alarm;
  CalibrationStatus calibration;
  VolumeFeed::Progress volume;
};

/// Where the control thread puts the snapshot and other threads look at it.
class StatusBoard {
 public:
  void publish(JobStatus status);
  std::shared_ptr<const JobStatus> look() const;

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const JobStatus> status_ = std::make_shared<const JobStatus>();
};

}  // namespace biotomy::acquisition
