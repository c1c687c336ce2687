// How a job is stopped by a fault, or made to wait.
#include <algorithm>
#include <string>
#include <utility>

#include "acquisition/job/job.hpp"
#include "acquisition/job/step_alarm.hpp"
#include "acquisition/log.hpp"
#include "acquisition/records/utc_time.hpp"
#include "firmware_bridge/device_error.hpp"

namespace biotomy::acquisition {
namespace {

constexpr const char* kComponent = "job";

}  // namespace

void Job::fault(const StopCause& why, TimePoint now) {
  // First of all. Whoever else gave the controller commands, this one's number is a new one.
  if (last_status_) {
    commands_.raise_to(std::max(last_status_->sequence_started, last_status_->sequence_finished));
  }
  fault_stop_.begin(Supervision::line_cause(inputs_).has_value(), now);
  const std::string& cause = why.sentence;
  log_error(kComponent, std::string("stopped while ") + to_string(state_) + ": " + cause);
  alarm_ = Alarm{cause, utc_text(surroundings_.wall_clock()), state_, why.kind};
  note("alarm", cause);
  pause_cause_.clear();
  state_ = next_state(state_, JobEvent::alarm).value_or(JobState::faulted);
  start_up_latch_ = false;
  temperature_alarm_ = false;
  unattended_restart_.give_up();
  start_after_reset_ = false;
  if (reset_answer_) answers_.push_back({std::move(*reset_answer_), {false, cause}});
  reset_answer_.reset();
  step_begin_ = now;
  time_left_.interrupted();
  pause_requested_ = false;
  inspection_ = {};
  if (calibration_) end_calibration(CalibrationStatus::Progress::failed, cause);
  if (cycle_) cycle_->abandon(cause);
  lamp_and_tower(true);
}

void Job::halt(TimePoint now) {
  if (at_rest()) return;
  fault({AlarmKind::ending, "the daemon was stopped before the rig was at rest"}, now);
}

void Job::add_to_alarm(const std::string& cause) {
  log_error(kComponent, cause);
  note("alarm", cause);
  alarm_->cause += "; " + cause;
  alarm_->since = utc_text(surroundings_.wall_clock());
}

void Job::break_off_parking(const std::string& cause, TimePoint now) {
  if (fault_stop_.break_off(now)) add_to_alarm("the parking was broken off: " + cause);
}

void Job::hold(Hold::For what, const std::string& cause, TimePoint now) {
  log_warning(kComponent, std::string("held while ") + to_string(state_) + ": " + cause);
  note("alarm", "held: " + cause);
  pause_cause_ = cause;
  hold_.begin(what, settings_.plan.layers - committed_, now);
  try {
    go(JobEvent::hold, now);
  } catch (const std::exception& error) {
    fault({alarm_kind_of(error, state_), error.what()}, now);
  }
}

void Job::lamp_and_tower(bool tower) {
  for (const auto& [role, on] : {std::pair{bridge::OutputRole::lamp, false},
                                 std::pair{bridge::OutputRole::tower_light, tower}}) {
    try {
      parts_.lines.set(role, on);
    } catch (const bridge::DeviceError& error) {
      // Neither lamp nor tower light hold up the stop. A rig without a tower light says so here.
      log_warning("lines", error.what());
    }
  }
}

}  // namespace biotomy::acquisition
