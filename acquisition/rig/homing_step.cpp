#include "acquisition/rig/homing_step.hpp"

namespace biotomy::acquisition {

bool HomingStep::poll(const bridge::StageStatus& status, TimePoint now) {
  if (!commanded_) {
    if (status.interlocks.homed) return true;
    commands_.begin({.action = bridge::StageAction::home}, now);
    commanded_ = true;
    return false;
  }
  if (!commands_.poll_done(status, now)) return false;
  if (!status.interlocks.homed) {
    throw StepFailure("the controller finished homing but says that it is not homed");
  }
  return true;
}

}  // namespace biotomy::acquisition
