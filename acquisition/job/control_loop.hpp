#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include "acquisition/rig/step_failure.hpp"

namespace biotomy::acquisition {

/// Calls `tick` at a steady rate from a thread of its own, until destroyed. A tick that took longer
/// is followed at once by the next, but late ticks are not made up for. If a tick throws, `failed`
/// is called with the text and the loop ends: the controller's watchdog then stops the rig.
class ControlLoop {
 public:
  ControlLoop(std::chrono::milliseconds period, std::function<void(TimePoint)> tick,
              std::function<void(const char*)> failed);
  ~ControlLoop();
  ControlLoop(const ControlLoop&) = delete;
  ControlLoop& operator=(const ControlLoop&) = delete;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace biotomy::acquisition
