#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>

#include "firmware_bridge/wire/rig_messages.hpp"
#include "sim/control/controller.hpp"
#include "sim/control/modbus_server.hpp"
#include "sim/physics/camera.hpp"
#include "sim/physics/mechanics.hpp"
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

  SafetyInputs inputs() const;
  void set_input(bridge::RigInput input, bool on);
  void set_output(bridge::RigOutput output, bool on);

  /// What the camera sees, now.
  Scene scene() const;

  double rig_seconds() const;
  double time_scale() const { return settings_.time_scale; }

 private:
  ControllerEvents events();
  void finish_command(const Command& command, CommandResult result);
  void write_state();
  bool was_ground() const;  ///< since the state was written

  RigSettings settings_;
  StateFile state_file_;
  WitnessLog& witness_;

  mutable std::mutex mutex_;
  Mechanics mechanics_;
  Controller controller_;
  Block block_before_;  ///< when the present command began
  SafetyInputs inputs_;
  bool lamp_on_ = false;
  bool trigger_on_ = false;
  bool tower_light_on_ = false;
  double rig_s_ = 0;
  RealTime now_;
  RealTime state_written_at_;
  Block::State block_kept_;  ///< as the state file has it
};

}  // namespace biotomy::sim
