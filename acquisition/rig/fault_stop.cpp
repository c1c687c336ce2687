#include "acquisition/rig/fault_stop.hpp"

#include <utility>

#include "acquisition/rig/stage_checks.hpp"

namespace biotomy::acquisition {

FaultStop::FaultStop(StageCommands& commands, const SafetyLimits& limits)
    : commands_(commands), limits_(limits), parking_(commands, limits) {}

void FaultStop::begin(bool stop_only, TimePoint now) {
  stop(now);
  phase_ = Phase::wanted;
  stop_only_ = stop_only;
  park_until_ = now + limits_.park_limit;
  stops_what_it_finds_ = false;
}

bool FaultStop::break_off(TimePoint now) {
  if (std::exchange(stop_only_, true)) return false;
  stop(now);
  phase_ = Phase::wanted;
  return true;
}

void FaultStop::observe(const bridge::StageStatus& status) {
  const bool halted = status.state == bridge::ControllerState::idle ||
                      status.state == bridge::ControllerState::faulted;
  seen_at_rest_ = seen_at_rest_ || (halted && wheel_stands(status, limits_));
}

std::vector<std::string> FaultStop::poll(const Status& status, TimePoint now) {
  Remarks remarks;
  stop_what_is_found(status, now, remarks);
  stop_again(status, now, remarks);
  if (phase_ == Phase::none) return remarks;
  if (now > park_until_) {
    give_up("it took too long: " +
                (status ? parking_.waiting_for() : std::string("the controller is not seen")),
            status, remarks);
  } else if (status && !stop_wanted_) {
    park(*status, now, remarks);
  }
  return remarks;
}

void FaultStop::stop(TimePoint now) {
  stop_wanted_ = !commands_.stop_now(now);
  stop_wanted_since_ = now;
}

/// A daemon that starts knows of nothing that may be at work. A controller that boots or is faulted
/// halts what moves by itself.
void FaultStop::stop_what_is_found(const Status& status, TimePoint now, Remarks& remarks) {
  const bool decides = status && (status->state == bridge::ControllerState::idle ||
                                  status->state == bridge::ControllerState::busy);
  if (!decides || !std::exchange(stops_what_it_finds_, false) || seen_at_rest_) return;
  stop(now);
  remarks.emplace_back("the rig was found at work and is stopped");
}

void FaultStop::stop_again(const Status& status, TimePoint now, Remarks& remarks) {
  constexpr std::chrono::milliseconds kBlindRetry{500};  // an unanswered one holds the tick up
  if (stop_wanted_ && (status || now - stop_tried_at_ > kBlindRetry)) {
    stop_tried_at_ = now;
    stop_wanted_ = !commands_.stop_now(now);
  }
  const bool unconfirmed = stop_wanted_ || phase_ == Phase::wanted ||
                           (phase_ == Phase::parking && parking_.waits_for_stop());
  if (unconfirmed && now - stop_wanted_since_ > limits_.command_start &&
      (stop_wanted_ || !status)) {
    leave_to_the_watchdog(status ? "the controller does not take it" : "it does not answer",
                          remarks);
  }
}

// On an e-stop, an open door or a fault of its own the controller retracts by itself, and takes no
// command: then there is nothing more to do. What only our own lines have seen it does not know of;
// then the stop is all that it is told, and it must be seen to take it.
void FaultStop::park(const bridge::StageStatus& status, TimePoint now, Remarks& remarks) {
  const bool controller_acts = status.state == bridge::ControllerState::faulted ||
                               status.interlocks.estop_pressed || status.interlocks.door_open;
  try {
    if (phase_ == Phase::wanted) {
      parking_.begin(Parking::From::stopped, now);
      phase_ = Phase::parking;
    }
    const bool stop_is_all = stop_only_ && !parking_.waits_for_stop();
    if (controller_acts || (stop_is_all && wheel_stands(status, limits_)) ||
        (!stop_is_all && parking_.poll(status, now))) {
      phase_ = Phase::none;
    }
  } catch (const StepFailure& failure) {
    const bool unstopped = parking_.waits_for_stop();
    give_up(failure.what(), status, remarks);
    if (unstopped) leave_to_the_watchdog(failure.what(), remarks);
  }
}

void FaultStop::give_up(const std::string& why, const Status& status, Remarks& remarks) {
  phase_ = Phase::none;
  remarks.push_back("the rig could not be parked: " + why);
  if (status && wheel_turns(*status, limits_)) leave_to_the_watchdog("the wheel turns", remarks);
}

void FaultStop::leave_to_the_watchdog(const std::string& why, Remarks& remarks) {
  if (std::exchange(heartbeat_withheld_, true)) return;
  remarks.push_back("the stop is not confirmed (" + why +
                    "): the controller's watchdog is left to stop the wheel; look whether it "
                    "stands");
}

}  // namespace biotomy::acquisition
