#pragma once

#include <string>

#include "acquisition/rig/stage_commands.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "acquisition/settings/safety_limits.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Takes the wheel off the block, parks the block, and waits until the wheel stands: what the
/// controller calls done may still run down, and one that turns on is no place for the next step.
class Retraction {
 public:
  Retraction(StageCommands& commands, const SafetyLimits& limits);

  void begin(TimePoint now);

  /// True when all of it is so. Throws StepFailure when the controller does not do it, or the block
  /// is not where it should be. How long it may take is for the caller to say.
  bool poll(const bridge::StageStatus& status, TimePoint now);

  std::string waiting_for() const;

 private:
  StageCommands& commands_;
  SafetyLimits limits_;
  bool retracted_ = false;
  double spindle_rpm_ = 0.0;  ///< when it was looked at last
};

}  // namespace biotomy::acquisition
