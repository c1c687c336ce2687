#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <mutex>

#include <nlohmann/json_fwd.hpp>

#include "firmware_bridge/wire/unique_fd.hpp"
#include "sim/control/controller.hpp"
#include "sim/physics/block.hpp"
#include "sim/scenario/scenario.hpp"

namespace biotomy::sim {

/// What is true of a photograph, whatever it shows.
struct CaptureFacts {
  std::uint64_t number = 0;
  double face_um = 0;
  double column_um = 0;  ///< as its scale shows it
  double defocus_um = 0;
  double blur_sigma_um = 0;
  bool face_in_view = false;
  bool lamp_on = false;
  std::size_t specks = 0;  ///< of debris, on the face
  double lamp_share = 0;   ///< of the light that there should be
  double vibration_mm_s = 0;
  bool spoilt = false;  ///< what was given is not what was photographed
};

/// What the twin saw happen, one JSON object a line, appended and never rewritten: the independent
/// witness against which the daemon's journal is tested. Each line has "time" (UTC), "rig_s" (rig
/// time since the start) and "event"; README.md lists the events. A line is written whole, by one
/// call, so that a killed twin leaves no half of one. Any thread.
class WitnessLog {
 public:
  using Clock = std::function<std::chrono::system_clock::time_point()>;

  /// An empty path: nothing is written. Throws std::system_error if the file can't be opened.
  WitnessLog(const std::filesystem::path& file, Clock clock);

  /// With what it remembers: how the last command ended that its killed predecessor had begun, and
  /// the block as that left it.
  void twin_started(double rig_s, std::uint64_t seed, const ControllerMemory& memory,
                    const Block& block);
  void command_started(double rig_s, const Command& command);
  void command_finished(double rig_s, const Command& command, CommandResult result);
  void grind_pass(double rig_s, const Command& command, CommandResult result, const Block& before,
                  const Block& after, double wheel_worn_um);
  void faulted(double rig_s, Fault fault);
  void fault_reset(double rig_s);
  void homed(double rig_s, bool homed);
  void controller_power(double rig_s, bool on);
  void spindle_started(double rig_s, double target_rpm);

  /// It turned for `turned_s`, the last `run_down_s` of it after it was told to stop. Rig time.
  void spindle_stopped(double rig_s, double turned_s, double run_down_s);
  void fault_began(double rig_s, const ScenarioEvent& event);
  void fault_ended(double rig_s, const ScenarioEvent& event);
  void input_changed(double rig_s, const char* input, bool on);
  void output_changed(double rig_s, const char* output, bool on);
  void capture(double rig_s, const CaptureFacts& facts);

 private:
  void write(double rig_s, const char* event, const nlohmann::ordered_json& facts);

  bridge::UniqueFd file_;
  Clock clock_;
  std::mutex writing_;
};

}  // namespace biotomy::sim
