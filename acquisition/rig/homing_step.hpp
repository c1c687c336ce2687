#pragma once

#include "acquisition/rig/stage_commands.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Lets the axes find their reference, unless the controller says that they have it.
class HomingStep {
 public:
  explicit HomingStep(StageCommands& commands) : commands_(commands) {}

  void begin() { commanded_ = false; }

  /// True when the axes are homed. Throws StepFailure when they cannot be.
  bool poll(const bridge::StageStatus& status, TimePoint now);

 private:
  StageCommands& commands_;
  bool commanded_ = false;
};

}  // namespace biotomy::acquisition
