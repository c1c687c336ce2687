#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acquisition/rig/parking.hpp"
#include "acquisition/rig/stage_commands.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "acquisition/settings/safety_limits.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Brings the rig to rest after a fault: the stop, given again until the controller has taken it;
/// then the parking, unless somebody may be near. What is found at work when the daemon starts is
/// stopped likewise.
///
/// It also says whether the controller may have its heartbeat. Not before the rig was seen at rest
/// since the daemon started, as what is found at work is nobody's; and not after a stop that was
/// not confirmed: then the controller's watchdog shall stop the wheel.
class FaultStop {
 public:
  FaultStop(StageCommands& commands, const SafetyLimits& limits);

  /// Stops what moves, before anything else. With `stop_only` nothing is moved afterwards.
  void begin(bool stop_only, TimePoint now);

  /// Somebody may be near now: what moves stops where it is. False when that was so already.
  bool break_off(TimePoint now);

  /// Each view of the controller, whatever the job does.
  void observe(const bridge::StageStatus& status);

  /// Moves on, at each tick of a job that is faulted. `status` is this tick's; nothing when the
  /// controller did not answer. What comes back belongs into the alarm.
  std::vector<std::string> poll(const std::optional<bridge::StageStatus>& status, TimePoint now);

  /// Nothing is to be stopped or parked any more.
  bool is_over() const { return phase_ == Phase::none && !stop_wanted_; }

  bool gives_heartbeat() const { return seen_at_rest_ && !heartbeat_withheld_; }

  /// A person has looked at the rig.
  void acknowledge() { heartbeat_withheld_ = false; }

 private:
  enum class Phase { none, wanted, parking };
  using Status = std::optional<bridge::StageStatus>;
  using Remarks = std::vector<std::string>;

  void stop(TimePoint now);
  void stop_what_is_found(const Status& status, TimePoint now, Remarks& remarks);
  void stop_again(const Status& status, TimePoint now, Remarks& remarks);
  void park(const bridge::StageStatus& status, TimePoint now, Remarks& remarks);
  void give_up(const std::string& why, const Status& status, Remarks& remarks);
  void leave_to_the_watchdog(const std::string& why, Remarks& remarks);

  StageCommands& commands_;
  SafetyLimits limits_;
  Parking parking_;

  Phase phase_ = Phase::none;
  bool stop_only_ = false;
  bool stop_wanted_ = false;  ///< the stage has not listened yet
  TimePoint stop_wanted_since_{};
  TimePoint stop_tried_at_{};
  TimePoint park_until_{};

  bool seen_at_rest_ = false;
  bool heartbeat_withheld_ = false;
  bool stops_what_it_finds_ = true;  ///< at work, once
};

}  // namespace biotomy::acquisition
