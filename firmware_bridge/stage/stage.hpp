#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "firmware_bridge/micrometres.hpp"

namespace biotomy::bridge {

/// What the controller of the rig is doing (register `controller_state`).
enum class ControllerState : std::uint16_t { booting = 0, idle = 1, busy = 2, faulted = 3 };

/// How the last finished command ended (register `command_result`).
enum class CommandResult : std::uint16_t { none = 0, done = 1, refused = 2, aborted = 3 };

/// What the controller can be told to do (register `command`).
enum class StageAction : std::uint16_t {
  home = 1,         ///< find the reference of every axis
  grind_pass = 2,   ///< one pass of the wheel with the feed axis at `position`
  retract = 3,      ///< wheel up and stopped, block parked under the camera
  move_column = 4,  ///< camera column to `position`
  clear_face = 5,   ///< air blast over the face for `duration`
  stop = 6,         ///< spindle off, axes halted; never waits
  reset_fault = 7,  ///< leave `faulted`; refused while the cause persists
};

struct StageCommand {
  StageAction action = StageAction::stop;
  Micrometres position{};                 ///< absolute; for grind_pass and move_column
  std::chrono::milliseconds duration{0};  ///< for clear_face
  double spindle_rpm = 0.0;               ///< for grind_pass
};

/// The controller's own view of its interlocks (register `interlocks`).
struct Interlocks {
  bool estop_pressed = true;
  bool door_open = true;
  bool watchdog_tripped = true;
  bool homed = false;
};

struct AxisLimits {
  Micrometres minimum{};
  Micrometres maximum{};
};

/// What does not change while the controller runs; read once, after connecting.
struct StageIdentity {
  std::uint16_t map_version = 0;
  std::chrono::milliseconds watchdog_timeout{0};  ///< 0: the controller does not watch its master
  AxisLimits feed;
  AxisLimits traverse;
  AxisLimits column;
};

/// One consistent reading of the controller. Sequence numbers are the proof of what was done: a
/// command is executed once, for a number beyond all before it, and the controller echoes the
/// number it started and the number it finished.
struct StageStatus {
  ControllerState state = ControllerState::booting;
  std::uint16_t fault_code = 0;
  Interlocks interlocks;
  std::uint16_t controller_heartbeat = 0;
  CommandResult last_result = CommandResult::none;
  std::uint32_t sequence_started = 0;
  std::uint32_t sequence_finished = 0;
  std::uint32_t grind_count = 0;  ///< finished grind passes; survives a restart of the controller
  Micrometres feed{};
  Micrometres traverse{};
  Micrometres column{};
  Micrometres feed_target{};  ///< where the axis is going; `feed` when it is at rest
  Micrometres traverse_target{};
  Micrometres column_target{};
  Micrometres ground_to{};  ///< the deepest feed position at which a pass was finished
  double spindle_rpm = 0.0;
  double spindle_load_percent = 0.0;
  double vibration_mm_s = 0.0;
  double block_temperature_c = 0.0;
  double chamber_temperature_c = 0.0;
  bool coolant_on = false;
  bool air_on = false;
};

/// The grinding stage as the acquisition needs it. One thread owns a stage; no call blocks for
/// longer than the link's response time-out times its retries.
/// Every call throws DeviceError.
class Stage {
 public:
  virtual ~Stage() = default;

  virtual StageIdentity identify() = 0;

  /// Reads one snapshot of the status and writes nothing: a controller that has heard no heartbeat
  /// yet does not begin to watch for the next.
  virtual StageStatus look() = 0;

  /// Writes the daemon's heartbeat and reads one snapshot of the status.
  virtual StageStatus exchange(std::uint16_t heartbeat) = 0;

  /// Hands over a command under a number that the controller has not started. After a time-out it
  /// is never repeated here: the caller reads `sequence_started` back and decides. Handing it over
  /// again under the same number is safe, since the controller starts each number once.
  virtual void issue(std::uint32_t sequence, const StageCommand& command) = 0;
};

const char* to_string(ControllerState state);
const char* to_string(CommandResult result);
const char* to_string(StageAction action);

}  // namespace biotomy::bridge
