#include "acquisition/rig/parking.hpp"

namespace biotomy::acquisition {

Parking::Parking(StageCommands& commands, const SafetyLimits& limits)
    : commands_(commands), limits_(limits), retraction_(commands, limits) {}

void Parking::begin(From from, TimePoint now) {
  switch (from) {
    case From::rest:
      phase_ = Phase::wait_for_idle;
      break;
    case From::motion:
      phase_ = Phase::stop;
      break;
    case From::stopped:
      phase_ = Phase::stopping;
      break;
  }
  deadline_ = now + limits_.park_limit;
}

bool Parking::poll(const bridge::StageStatus& status, TimePoint now) {
  if (phase_ != Phase::parked && now > deadline_) {
    throw StepFailure("parking took too long: " + waiting_for(), AlarmKind::time_limit);
  }
  switch (phase_) {
    case Phase::stop:
      if (commands_.stop_now(now)) phase_ = Phase::stopping;
      return false;
    case Phase::stopping:
      if (const auto result = commands_.poll(status, now)) {
        if (*result == bridge::CommandResult::refused) {
          throw StepFailure("the controller refused to stop", AlarmKind::controller);
        }
        phase_ = Phase::wait_for_idle;
      }
      return false;
    case Phase::wait_for_idle:
      if (status.state == bridge::ControllerState::idle) {
        phase_ = Phase::retract;
        retraction_.begin(now);
      }
      return false;
    case Phase::retract:
      if (retraction_.poll(status, now)) phase_ = Phase::parked;
      return phase_ == Phase::parked;
    case Phase::parked:
      return true;
  }
  return false;
}

std::string Parking::waiting_for() const {
  switch (phase_) {
    case Phase::stop:
    case Phase::stopping:
      return "waits for the controller to take the stop";
    case Phase::wait_for_idle:
      return "waits for the controller to come to rest";
    case Phase::retract:
      return retraction_.waiting_for();
    case Phase::parked:
      return "";
  }
  return "";
}

}  // namespace biotomy::acquisition
