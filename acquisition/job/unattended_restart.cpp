#include "acquisition/job/unattended_restart.hpp"

#include "acquisition/rig/stage_checks.hpp"
#include "acquisition/rig/supervision.hpp"

namespace biotomy::acquisition {
namespace {

/// The rig must have been good for so long, within so long: after a power cut a controller, or the
/// switch before it, may start more slowly than this computer.
constexpr std::chrono::seconds kLookFor{2};
constexpr std::chrono::minutes kLookLimit{5};
constexpr std::uint16_t kWatchdogFault = 3;

}  // namespace

UnattendedRestart::UnattendedRestart(bool wanted, const SafetyLimits& limits)
    : wanted_(wanted), limits_(limits) {}

UnattendedRestart::Decision UnattendedRestart::poll(
    const std::optional<bridge::StageStatus>& status, const std::optional<StopCause>& standing,
    bool stopping, TimePoint now) {
  if (!wanted_) return {};
  if (!began_) began_ = now;
  if (now - *began_ > kLookLimit) {
    return refuse("the rig was not ready within " + std::to_string(kLookLimit.count()) + " min");
  }
  // Somebody was there. Lines that cannot be read, or a link that is not up, may be so at a start.
  if (standing &&
      (standing->kind == AlarmKind::emergency_stop || standing->kind == AlarmKind::door)) {
    return refuse(standing->sentence);
  }
  const bool ready = status && !standing && wheel_stands(*status, limits_) && !stopping &&
                     status->state != bridge::ControllerState::busy &&
                     status->state != bridge::ControllerState::booting;
  if (!ready) {
    good_since_.reset();
    return {};
  }
  // That its watchdog tripped is what a daemon that ended had to cause. Any other fault is news.
  if (status->state == bridge::ControllerState::faulted && status->fault_code != kWatchdogFault) {
    return refuse(std::string("the controller is faulted: ") + fault_text(status->fault_code));
  }
  if (!good_since_) good_since_ = now;
  if (now - *good_since_ < kLookFor) return {};
  wanted_ = false;
  return {true, ""};
}

UnattendedRestart::Decision UnattendedRestart::refuse(const std::string& why) {
  wanted_ = false;
  return {false, "the job did not go on by itself after a restart, since " + why +
                     ": look at the rig, then acknowledge"};
}

}  // namespace biotomy::acquisition
