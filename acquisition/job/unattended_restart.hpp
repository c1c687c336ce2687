#pragma once

#include <optional>
#include <string>

#include "acquisition/rig/alarm_kind.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "acquisition/settings/safety_limits.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Whether a job that was running when the daemon before this one ended goes on by itself: once the
/// rig has been for a while as that daemon's end must have left it, unless a person comes first.
class UnattendedRestart {
 public:
  UnattendedRestart(bool wanted, const SafetyLimits& limits);

  struct Decision {
    bool goes_on = false;
    std::string why_not;  ///< a person must look at the rig; empty: nothing is decided yet
  };

  /// At every tick. `status` is this tick's, `standing` what Supervision::standing_cause says, and
  /// `stopping` that the rig is still being stopped. Each decision is said once.
  Decision poll(const std::optional<bridge::StageStatus>& status,
                const std::optional<StopCause>& standing, bool stopping, TimePoint now);

  /// There is a person, or an alarm.
  void give_up() { wanted_ = false; }

 private:
  Decision refuse(const std::string& why);

  bool wanted_;
  SafetyLimits limits_;
  std::optional<TimePoint> began_;
  std::optional<TimePoint> good_since_;
};

}  // namespace biotomy::acquisition
