#include "acquisition/rig/stage_identity.hpp"

#include "firmware_bridge/device_error.hpp"

namespace biotomy::acquisition {

std::optional<bridge::StageIdentity> ask_identity(bridge::Stage& stage) {
  try {
    return stage.identify();
  } catch (const bridge::DeviceError& error) {
    const bool may_answer_yet = error.kind() == bridge::DeviceError::Kind::timeout ||
                                error.kind() == bridge::DeviceError::Kind::disconnected;
    if (!may_answer_yet) throw;
    return std::nullopt;
  }
}

std::optional<std::string> watchdog_complaint(const SafetyLimits& limits,
                                              const bridge::StageIdentity& stage) {
  if (stage.watchdog_timeout.count() != 0 || !limits.require_watchdog) return std::nullopt;
  return "the controller does not watch the daemon's heartbeat (watchdog_timeout is 0): set it, "
         "or set safety.require_watchdog to false";
}

}  // namespace biotomy::acquisition
