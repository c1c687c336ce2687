#pragma once

#include <cstdint>

namespace biotomy::sim {

/// What the register `command` may hold.
enum class Action : std::uint16_t {
  home = 1,
  grind_pass = 2,
  retract = 3,
  move_column = 4,
  clear_face = 5,
  stop = 6,
  reset_fault = 7,
};

/// The command block as it was written: nothing in it has been believed yet.
struct Command {
  std::uint32_t sequence = 0;
  std::uint16_t action = 0;
  double position_um = 0;
  double duration_ms = 0;
  double spindle_rpm = 0;
};

/// What becomes of a command at the moment it is written.
enum class Acceptance {
  taken,     ///< started, and perhaps finished already: the registers tell
  repeated,  ///< its number is not beyond that of the last command: nothing happens
  busy,      ///< another one is running: not started, the number is not used up
};

enum class ControllerState : std::uint16_t { booting = 0, idle = 1, busy = 2, faulted = 3 };
enum class CommandResult : std::uint16_t { none = 0, done = 1, refused = 2, aborted = 3 };
enum class Fault : std::uint16_t {
  none = 0,
  estop = 1,
  door = 2,
  watchdog = 3,
  limit = 4,  ///< an axis beyond its limits
  drive = 5,  ///< an axis or the spindle doesn't do what it is told
  spindle_overload = 6,
};

const char* to_string(Fault fault);
const char* to_string(CommandResult result);

/// The action's name, "unknown" for a number that is none.
const char* name_of_action(std::uint16_t action);

}  // namespace biotomy::sim
