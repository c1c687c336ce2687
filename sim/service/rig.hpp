#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "firmware_bridge/wire/rig_messages.hpp"
#include "sim/control/controller.hpp"
#include "sim/control/controller_port.hpp"
#include "sim/physics/camera.hpp"
#include "sim/physics/mechanics.hpp"
#include "sim/scenario/rig_condition.hpp"
#include "sim/scenario/schedule.hpp"
#include "sim/service/state_file.hpp"
#include "sim/service/witness_log.hpp"

namespace biotomy::sim {

struct RigSettings {
  std::uint64_t seed = 1;
  double time_scale = 1;  ///< seconds of the rig in a second of real time
  double initial_face_um = 0;
  double roughness_um = 0.3;
  DebrisSettings debris{};
  MechanicsSettings mechanics{};
  ControllerSettings controller{};
  Scenario scenario{};
};

/// The rig as a whole: machine, controller, lines, behind one lock, so that its parts never
/// disagree. Time passes by advance() alone. What happens is told to the witness, and what has to
/// outlive the process is in the state file before anybody can learn of it: the controller's memory
/// as in a real one, and what the wheel took off, since a killed twin must not heal the block. Any
/// thread.
class Rig final : public ControllerPort {
 public:
  using RealTime = Controller::RealTime;

  /// Takes up the state that the file holds, if any; `now` is when time begins.
  Rig(const RigSettings& settings, StateFile state_file, WitnessLog& witness, RealTime now);

  /// Lets the rig's time catch up with `now`, in steps of a few milliseconds of the rig.
  void advance(RealTime now);

  /// Writes the state file: before the process ends.
  void keep_state();

  ControllerReading read() override;
  void hear_master(std::uint16_t heartbeat) override;
  Acceptance submit(const Command& command) override;
  bool answers() const override;

  SafetyInputs inputs() const;
  void set_input(bridge::RigInput input, bool on);
  void set_output(bridge::RigOutput output, bool on);

  /// Something breaks beside the scenario (Schedule::add), or is mended. The latter is false if
  /// there is no event of the name.
  void add_event(const ScenarioEvent& event);
  bool end_event(const std::string& name);

  /// What the camera sees, now.
  Scene scene() const;

  /// What is wrong with camera and lines, now.
  CameraCondition camera_condition() const;
  bool lines_silent() const;

  /// Around each photograph; the camera's condition while it is taken.
  CameraCondition begin_capture();
  void end_capture();

  /// The camera was asked for something and could not answer.
  void note_camera_failure();

  double rig_seconds() const;
  double time_scale() const { return settings_.time_scale; }

 private:
  ControllerEvents events();
  ScheduleEvents schedule_events();
  void finish_command(const Command& command, CommandResult result);
  void follow_schedule();
  void follow_inputs();
  void watch_spindle();
  void write_state();
  bool was_ground() const;  ///< since the state was written

  RigSettings settings_;
  StateFile state_file_;
  WitnessLog& witness_;

  mutable std::mutex mutex_;
  Mechanics mechanics_;
  Controller controller_;
  Schedule schedule_;
  RigCondition condition_;
  bool is_sound_ = true;  ///< nothing is broken, and the condition says so
  Block block_before_;    ///< when the present command began
  SafetyInputs bench_inputs_;
  SafetyInputs inputs_;  ///< what the bench and the faults make of them together
  bool spindle_turns_ = false;
  double spindle_started_s_ = 0;
  std::optional<double> spindle_released_s_{};  ///< when it was told to stop, while it turns
  bool lamp_on_ = false;
  bool trigger_on_ = false;
  bool tower_light_on_ = false;
  double rig_s_ = 0;
  RealTime now_;
  RealTime state_written_at_;
  Block::State block_kept_;  ///< as the state file has it
};

}  // namespace biotomy::sim
