#include "acquisition/job/parking.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace biotomy::acquisition {

Parking::Parking(StageCommands& commands, const SafetyLimits& limits)
    : commands_(commands), limits_(limits) {}

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
        commands_.begin({.action = bridge::StageAction::retract}, now);
      }
      return false;
    case Phase::retract:
      if (commands_.poll_done(status, now)) {
        check_position("traverse", status.traverse, {0.0}, limits_);
        phase_ = Phase::parked;
      }
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
      return "waits for the wheel to be retracted";
    case Phase::parked:
      return "";
  }
  return "";
}

void check_position(const char* axis, bridge::Micrometres actual, bridge::Micrometres expected,
                    const SafetyLimits& limits) {
  if (std::abs((actual - expected).value) <= limits.position_tolerance.value) return;
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                "the %s is at %.1f µm and should be at %.1f µm: look for what holds it", axis,
                actual.value, expected.value);
  throw StepFailure(text.data(), AlarmKind::motion);
}

}  // namespace biotomy::acquisition
