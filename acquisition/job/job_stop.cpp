// How a job is stopped by a fault, and the rig brought to rest after it.
#include <algorithm>
#include <string>
#include <utility>

#include "acquisition/job/job.hpp"
#include "acquisition/job/stage_checks.hpp"
#include "acquisition/log.hpp"
#include "acquisition/records/utc_time.hpp"

namespace biotomy::acquisition {
namespace {

constexpr const char* kComponent = "job";

}  // namespace

void Job::fault(const StopCause& why, TimePoint now) {
  // First of all. Whoever else gave the controller commands, this one's number is a new one.
  if (last_status_) {
    commands_.raise_to(std::max(last_status_->sequence_started, last_status_->sequence_finished));
  }
  stop_wanted_ = !commands_.stop_now(now);
  stop_wanted_since_ = now;
  const std::string& cause = why.sentence;
  log_error(kComponent, std::string("stopped while ") + to_string(state_) + ": " + cause);
  alarm_ = Alarm{cause, utc_text(surroundings_.wall_clock()), state_, why.kind};
  note("alarm", cause);
  pause_cause_.clear();
  state_ = next_state(state_, JobEvent::alarm).value_or(JobState::faulted);
  start_up_latch_ = stops_what_it_finds_ = false;
  temperature_alarm_ = false;
  may_go_on_by_itself_ = false;
  start_after_reset_ = false;
  if (reset_answer_) answers_.push_back({std::move(*reset_answer_), {false, cause}});
  reset_answer_.reset();
  step_begin_ = now;
  time_left_.interrupted();
  pause_requested_ = false;
  inspection_ = {};
  if (calibration_) end_calibration(CalibrationStatus::Progress::failed, cause);
  fault_parking_ = FaultParking::wanted;
  fault_parking_only_stops_ = Supervision::line_cause(inputs_).has_value();
  fault_park_until_ = now + settings_.limits.park_limit;
  if (cycle_) cycle_->abandon(cause);
  lamp_and_tower(true);
}

void Job::halt(TimePoint now) {
  if (at_rest()) return;
  fault({AlarmKind::ending, "the daemon was stopped before the rig was at rest"}, now);
}

void Job::park_after_fault(TimePoint now) {
  constexpr std::chrono::milliseconds kBlindRetry{500};  // an unanswered one holds the tick up
  stop_what_is_found(now);
  if (stop_wanted_ && (fresh_ || now - stop_tried_at_ > kBlindRetry)) {
    stop_tried_at_ = now;
    stop_wanted_ = !commands_.stop_now(now);
  }
  const bool unconfirmed = stop_wanted_ || (fault_parking_ == FaultParking::wanted) ||
                           (fault_parking_ == FaultParking::under_way && parking_.waits_for_stop());
  if (unconfirmed && now - stop_wanted_since_ > settings_.limits.command_start &&
      (stop_wanted_ || !fresh_)) {
    leave_to_the_watchdog(fresh_ ? "the controller does not take it" : "it does not answer");
  }
  if (fault_parking_ == FaultParking::none) return;
  if (now > fault_park_until_) {
    give_parking_up("it took too long: " +
                    (fresh_ ? parking_.waiting_for() : std::string("the controller is not seen")));
    return;
  }
  if (!fresh_ || stop_wanted_) return;

  // On an e-stop, an open door or a fault of its own the controller retracts by itself, and takes
  // no command: then there is nothing more to do. What only our own lines have seen it does not
  // know of; then the stop is all that it is told, and it must be seen to take it.
  const bool controller_acts = fresh_->state == bridge::ControllerState::faulted ||
                               fresh_->interlocks.estop_pressed || fresh_->interlocks.door_open;
  try {
    if (fault_parking_ == FaultParking::wanted) {
      parking_.begin(Parking::From::stopped, now);
      fault_parking_ = FaultParking::under_way;
    }
    const bool stop_is_all = fault_parking_only_stops_ && !parking_.waits_for_stop();
    if (controller_acts || (stop_is_all && wheel_stands(*fresh_, settings_.limits)) ||
        (!stop_is_all && parking_.poll(*fresh_, now))) {
      fault_parking_ = FaultParking::none;
    }
  } catch (const StepFailure& failure) {
    const bool unstopped = parking_.waits_for_stop();
    give_parking_up(failure.what());
    if (unstopped) leave_to_the_watchdog(failure.what());
  }
}

/// A daemon that starts knows of nothing that may be at work. A controller that boots or is faulted
/// halts what moves by itself.
void Job::stop_what_is_found(TimePoint now) {
  const bool decides = fresh_ && (fresh_->state == bridge::ControllerState::idle ||
                                  fresh_->state == bridge::ControllerState::busy);
  if (!decides || !stops_what_it_finds_) return;
  stops_what_it_finds_ = false;
  if (seen_at_rest_) return;
  add_to_alarm("the rig was found at work and is stopped");
  stop_wanted_ = !commands_.stop_now(now);
  stop_wanted_since_ = now;
}

void Job::give_parking_up(const std::string& why) {
  fault_parking_ = FaultParking::none;
  add_to_alarm("the rig could not be parked: " + why);
  if (fresh_ && wheel_turns(*fresh_, settings_.limits)) leave_to_the_watchdog("the wheel turns");
}

/// The wheel may still turn. A controller that hears no heartbeat any more stops it by itself.
void Job::leave_to_the_watchdog(const std::string& why) {
  if (std::exchange(heartbeat_withheld_, true)) return;
  add_to_alarm("the stop is not confirmed (" + why +
               "): the controller's watchdog is left to stop the wheel; look whether it stands");
}

void Job::add_to_alarm(const std::string& cause) {
  log_error(kComponent, cause);
  note("alarm", cause);
  alarm_->cause += "; " + cause;
  alarm_->since = utc_text(surroundings_.wall_clock());
}

/// Of a rig that is parked after a fault: what moves stops here, too.
void Job::break_off_parking(const std::string& cause, TimePoint now) {
  if (std::exchange(fault_parking_only_stops_, true)) return;
  stop_wanted_ = !commands_.stop_now(now);
  stop_wanted_since_ = now;
  fault_parking_ = FaultParking::wanted;
  add_to_alarm("the parking was broken off: " + cause);
}

}  // namespace biotomy::acquisition
