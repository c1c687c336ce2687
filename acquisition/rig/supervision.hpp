#pragma once

#include <optional>
#include <string>

#include "acquisition/rig/alarm_kind.hpp"
#include "acquisition/rig/motion_watch.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "acquisition/settings/safety_limits.hpp"
#include "firmware_bridge/lines/lines.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Watches the rig at every tick and says in one sentence why the wheel must stop, and what that is
/// about. It sees everything twice where there are two ways to see it (lines and controller), and
/// progress, not only limits: a heartbeat that does not beat is a controller whose program stands
/// still, an axis that does not come nearer to its target is stuck.
class Supervision {
 public:
  explicit Supervision(const SafetyLimits& limits);

  /// What this tick's exchange gave (nothing when it failed) and the safety lines.
  void observe(const std::optional<bridge::StageStatus>& status, const bridge::SafetyInputs& inputs,
               TimePoint now);

  /// Why the wheel must stop now, whatever the step is; nothing when all is well.
  std::optional<StopCause> cause() const;

  /// Why the wheel must stop by the lines alone, before the controller is asked.
  static std::optional<StopCause> line_cause(const bridge::SafetyInputs& inputs);

  /// That the block is outside its window of temperature for too long to work on it.
  std::optional<StopCause> temperature_cause() const;

  /// That the wheel turns, for the states in which it must stand.
  std::optional<StopCause> wheel_cause() const;

  /// Why the latch must not be opened: as `cause`, but without what resetting the controller cures.
  std::optional<StopCause> standing_cause() const;

  /// The machine was left to itself or to a person: where its axes were says nothing any more.
  void forget_positions() { motion_.forget(); }

 private:
  /// Since when a value is outside its limits.
  struct Excess {
    std::optional<TimePoint> since;
    void observe(bool outside, TimePoint now);
    bool lasts(std::chrono::milliseconds limit, TimePoint now) const;
  };

  std::optional<StopCause> interlock_cause() const;
  std::optional<StopCause> link_cause() const;
  std::optional<StopCause> machine_cause() const;

  SafetyLimits limits_;
  bridge::SafetyInputs inputs_;
  bridge::StageStatus status_;
  std::optional<TimePoint> last_exchange_;
  std::optional<TimePoint> first_observation_;
  std::optional<TimePoint> heartbeat_changed_;
  Excess temperature_;
  Excess load_;
  Excess vibration_;
  Excess wheel_;
  MotionWatch motion_;
  TimePoint now_{};
};

/// That a block of that temperature is outside its window; nothing when it is inside.
std::optional<std::string> temperature_complaint(const SafetyLimits& limits,
                                                 double block_temperature_c);

/// What a fault code of the register map means.
const char* fault_text(std::uint16_t fault_code);

}  // namespace biotomy::acquisition
