#pragma once

#include <optional>
#include <string>

#include "acquisition/job/safety_limits.hpp"
#include "acquisition/job/step_failure.hpp"
#include "firmware_bridge/lines/lines.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Watches the rig at every tick and says in one sentence why the wheel must stop. It sees
/// everything twice where there are two ways to see it (lines and controller), and progress, not
/// only limits: a heartbeat that does not beat is a controller whose program stands still.
class Supervision {
 public:
  explicit Supervision(const SafetyLimits& limits);

  /// What this tick's exchange gave (nothing when it failed) and the safety lines.
  void observe(const std::optional<bridge::StageStatus>& status, const bridge::SafetyInputs& inputs,
               TimePoint now);

  /// Why the wheel must stop now; nothing when all is well.
  std::optional<std::string> cause() const;

  /// Why the latch must not be opened: as `cause`, but without what resetting the controller cures.
  std::optional<std::string> standing_cause() const;

 private:
  std::optional<std::string> interlock_cause() const;
  std::optional<std::string> condition_cause() const;

  SafetyLimits limits_;
  bridge::SafetyInputs inputs_;
  bridge::StageStatus status_;
  std::optional<TimePoint> last_exchange_;
  std::optional<TimePoint> first_observation_;
  std::optional<TimePoint> heartbeat_changed_;
  std::optional<TimePoint> outside_window_since_;
  TimePoint now_{};
};

/// What a fault code of the register map means.
const char* fault_text(std::uint16_t fault_code);

}  // namespace biotomy::acquisition
