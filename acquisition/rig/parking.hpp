#pragma once

#include <string>

#include "acquisition/rig/retraction.hpp"
#include "acquisition/rig/stage_commands.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "acquisition/settings/safety_limits.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Brings the rig to rest: stops what moves, waits until the controller is idle, retracts the wheel
/// until it stands, and parks the block.
class Parking {
 public:
  Parking(StageCommands& commands, const SafetyLimits& limits);

  enum class From {
    rest,     ///< nothing is under way
    motion,   ///< what is under way is stopped first
    stopped,  ///< StageCommands::stop_now was just called
  };

  void begin(From from, TimePoint now);

  /// True when the rig is parked. Throws StepFailure when it cannot be.
  bool poll(const bridge::StageStatus& status, TimePoint now);

  /// The controller has not yet said that it took the stop.
  bool waits_for_stop() const { return phase_ == Phase::stop || phase_ == Phase::stopping; }

  std::string waiting_for() const;

 private:
  enum class Phase { stop, stopping, wait_for_idle, retract, parked };

  StageCommands& commands_;
  SafetyLimits limits_;
  Retraction retraction_;
  Phase phase_ = Phase::parked;
  TimePoint deadline_{};
};

}  // namespace biotomy::acquisition
