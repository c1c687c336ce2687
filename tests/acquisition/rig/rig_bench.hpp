#pragma once

#include <chrono>
#include <functional>

#include "acquisition/rig/stage_commands.hpp"
#include "acquisition/settings/safety_limits.hpp"
#include "tests/acquisition/fake_rig.hpp"

namespace biotomy::tests {

/// The commands to a fake stage, and its status, looked at every 20 ms. What a test does to the
/// status is seen by the step alone, not by the stage.
struct RigBench {
  FakeStage stage;
  acquisition::SafetyLimits limits;
  acquisition::StageCommands commands{stage, limits};
  acquisition::TimePoint now{};
  std::function<void(bridge::StageStatus&)> distort = [](auto&) {};

  bridge::StageStatus look() {
    now += std::chrono::milliseconds(20);
    bridge::StageStatus status = stage.exchange(0);
    distort(status);
    return status;
  }

  /// Polls the step until it is done; false when it does not get there.
  template <typename Step>
  bool finish(Step& step, int looks = 50) {
    for (int i = 0; i < looks; ++i) {
      const bridge::StageStatus status = look();
      if (step.poll(status, now)) return true;
    }
    return false;
  }
};

}  // namespace biotomy::tests
