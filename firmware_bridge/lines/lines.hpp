#pragma once

#include <string>

namespace biotomy::bridge {

enum class OutputRole { lamp, trigger, tower_light };

/// The safety inputs, polarity already applied: true if it is so, or was so at any time since the
/// last call, as far as the back end can see that. An input that cannot be read is reported in its
/// unsafe state, with the reason.
struct SafetyInputs {
  bool estop_pressed = true;
  bool door_open = true;
  std::string failure = {};  ///< why not every input could be read; empty when all were
};

/// The rig's digital lines, by role. Outputs go to off when the object is destroyed.
/// One thread owns it. `set` throws DeviceError.
class Lines {
 public:
  virtual ~Lines() = default;
  virtual SafetyInputs read_inputs() = 0;
  virtual void set(OutputRole role, bool on) = 0;
};

const char* to_string(OutputRole role);

}  // namespace biotomy::bridge
