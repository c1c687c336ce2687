#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>

#include "sim/control/command.hpp"
#include "sim/control/drive_monitor.hpp"
#include "sim/physics/mechanics.hpp"

namespace biotomy::sim {

/// The safety inputs as they are: one truth for the lines and for the controller.
struct SafetyInputs {
  bool estop_pressed = false;
  bool door_open = false;
};

struct ControllerSettings {
  double feed_minimum_um = 0;
  double feed_maximum_um = 60000;
  double column_minimum_um = 0;
  double column_maximum_um = 60000;
  double spindle_maximum_rpm = 6000;
  double lift_um = 2000;  ///< how far the wheel goes up for the way to and from the block
  std::chrono::milliseconds watchdog_timeout{2000};  ///< of real time; 0: no watchdog
  double boot_seconds = 0.3;
  DriveLimits drives;
};

/// What the controller keeps in its permanent memory.
struct ControllerMemory {
  std::uint32_t sequence_started = 0;
  std::uint32_t sequence_finished = 0;
  CommandResult result = CommandResult::none;
  std::uint32_t grind_count = 0;
  double ground_position_um = 0;
};

/// What it tells of itself; its memory and the mechanics are read beside it.
struct ControllerStatus {
  ControllerState state = ControllerState::booting;
  Fault fault = Fault::none;
  bool estop_pressed = false;
  bool door_open = false;
  bool watchdog_tripped = false;
  bool homed = false;
  std::uint16_t heartbeat = 0;
};

/// What the rest of the twin is told of, in the order in which it happens.
struct ControllerEvents {
  std::function<void(const Command&)> started = [](const Command&) {};
  std::function<void(const Command&, CommandResult)> finished = [](const Command&, CommandResult) {
  };
  std::function<void(Fault)> faulted = [](Fault) {};
  std::function<void()> reset = [] {};
  std::function<void(bool)> homed = [](bool) {};  ///< it knows its axes, or knows them no more
  /// Called at every change of the memory, before anything else happens.
  std::function<void()> memory_changed = [] {};
};

/// The rig's PLC: it turns commands into targets of the mechanics, one at a time, each number once,
/// and watches the interlocks and its master. The rules:
/// - a command starts only under a number beyond the last one started, so that a message that comes
///   late or twice starts nothing; while one runs, only `stop` is taken (the running one is then
///   `aborted`);
/// - refused: an unknown command, a target outside the limits, grinding or moving the column before
///   `home`, everything but `stop` and `reset_fault` while faulted;
/// - e-stop, open door and a silent master lead to `faulted`: spindle and air off, wheel up, axes
///   halted. Only `reset_fault` leaves it, and only once every cause is gone;
/// - so do an axis beyond its limits, an axis or a spindle that doesn't do what it is told for
/// longer
///   than DriveLimits allows, and an overloaded spindle; an axis beyond a limit is brought back to
///   it once e-stop and door allow, so that the cause can go;
/// - the master is watched from its first heartbeat on;
/// - without power nothing is known and nothing moves but what runs down; power that comes back
///   finds the permanent memory alone.
/// Two clocks come in by advance(): the rig's time moves the machine, real time the watchdog.
class Controller {
 public:
  using RealTime = std::chrono::steady_clock::time_point;

  Controller(const ControllerSettings& settings, Mechanics& mechanics, ControllerEvents events);

  Acceptance submit(const Command& command);

  /// The master's heartbeat register was written.
  void hear_master(std::uint16_t heartbeat);

  void set_inputs(const SafetyInputs& inputs);

  /// To be called at least every 50 ms of real time, and every few milliseconds of rig time.
  void advance(double rig_seconds, RealTime now);

  /// Power is cut, or comes back: then it boots. The command that was cut off is `aborted`.
  void set_power(bool on);
  bool powered() const { return powered_; }

  /// Its program goes on while its heartbeat stands still.
  void stop_heartbeat(bool stopped) { heartbeat_stopped_ = stopped; }

  ControllerStatus status() const;
  const ControllerMemory& memory() const { return memory_; }

  /// A command that was running when the memory was written is `aborted` now.
  void restore(const ControllerMemory& memory);

  const ControllerSettings& settings() const { return settings_; }

  /// How far the block goes: from where it is parked until the whole face has passed the wheel.
  double traverse_minimum_um() const { return 0; }
  double traverse_maximum_um() const;

 private:
  /// A part of a command: begin it, then wait until it has come to its end.
  struct Step {
    std::function<void()> begin;
    std::function<bool()> ended;
  };

  bool refuses(const Command& command) const;
  void begin(const Command& command);
  void finish(CommandResult result);
  void carry_on(double rig_seconds);
  void watch(RealTime now);
  void guard(double rig_seconds);
  Fault machine_fault() const;
  bool beyond_limits() const;
  void let_go();
  void set_homed(bool homed);
  void fall_into(Fault fault);
  bool reset_fault();
  void make_safe();
  double lifted(double feed_um) const;

  void plan(const Command& command);
  void plan_home();
  void plan_grind_pass(const Command& command);
  void plan_retract();
  Step move(Axis& axis, double target_um, double speed_um_s) const;
  Step spin(double rpm) const;

  ControllerSettings settings_;
  Mechanics& mechanics_;
  ControllerEvents events_;
  ControllerMemory memory_;
  DriveMonitor drives_;
  bool powered_ = true;
  bool heartbeat_stopped_ = false;
  ControllerState state_ = ControllerState::booting;
  Fault fault_ = Fault::none;
  SafetyInputs inputs_;
  bool homed_ = false;

  Command command_;  ///< the one that runs, while busy
  std::deque<Step> steps_;
  bool step_begun_ = false;
  double waited_ms_ = 0;  ///< rig time in the present step
  double boot_left_s_;

  std::uint16_t heartbeat_ = 0;
  RealTime heartbeat_at_{};
  std::uint16_t master_heartbeat_ = 0;
  bool master_known_ = false;
  bool master_heard_ = false;  ///< a change that advance() has not dated yet
  bool master_silent_ = false;
  bool watchdog_tripped_ = false;
  RealTime master_heard_at_{};
};

}  // namespace biotomy::sim
