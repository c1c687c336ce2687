#include "acquisition/rig/stage_identity.hpp"

#include "firmware_bridge/device_error.hpp"

namespace biotomy::acquisition {
namespace {

/// A heartbeat comes with every tick, which lasts up to 200 ms.
constexpr std::chrono::milliseconds kShortestWatchdog{250};
constexpr std::chrono::milliseconds kLongestWatchdog{5000};

std::string ms_text(std::chrono::milliseconds time) {
  return std::to_string(time.count()) + " ms";
}

}  // namespace

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
  if (!limits.require_watchdog) return std::nullopt;
  if (stage.watchdog_timeout.count() == 0) {
    return "the controller does not watch the daemon's heartbeat (watchdog_timeout is 0): set it, "
           "or set safety.require_watchdog to false";
  }
  if (stage.watchdog_timeout >= kShortestWatchdog && stage.watchdog_timeout <= kLongestWatchdog) {
    return std::nullopt;
  }
  return "the controller waits for the daemon's next heartbeat for " +
         ms_text(stage.watchdog_timeout) + " (watchdog_timeout), and should for " +
         ms_text(kShortestWatchdog) + " to " + ms_text(kLongestWatchdog) +
         ": set it, or set safety.require_watchdog to false";
}

}  // namespace biotomy::acquisition
