#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "firmware_bridge/wire/register_map.hpp"
#include "sim/control/controller.hpp"

namespace biotomy::sim {

/// The controller and the mechanics, as the master sees them in the input registers.
struct ControllerReading {
  ControllerStatus status;
  ControllerMemory memory;
  ControllerSettings settings;
  double feed_um = 0;
  double traverse_um = 0;
  double column_um = 0;
  double feed_target_um = 0;  ///< where the axis is going; feed_um when it is at rest
  double traverse_target_um = 0;
  double column_target_um = 0;
  double traverse_minimum_um = 0;
  double traverse_maximum_um = 0;
  double spindle_rpm = 0;
  double spindle_load_percent = 0;
  double vibration_mm_s = 0;
  double block_temperature_c = 0;
  double chamber_temperature_c = 0;
  bool coolant_on = false;
  bool air_on = false;
};

/// What a write to the holding registers amounts to.
struct RegisterWrite {
  bool allowed = false;    ///< all registers are known and writable
  bool heartbeat = false;  ///< the daemon's heartbeat was among them
  bool command = false;    ///< the sequence number was, so the command block is to be taken
};

/// The two tables of registers, laid out as the map says. Throws bridge::ConfigurationError if the
/// map lacks a name that the twin serves, or has it in the wrong table.
class ControllerRegisters {
 public:
  explicit ControllerRegisters(const bridge::RegisterMap& map);

  /// Brings the input registers up to date. A value that its register can't hold is shown as the
  /// nearest that it can.
  void show(const ControllerReading& reading);

  /// What writing `values` from `address` on would amount to; nothing is written.
  RegisterWrite judge(int address, int count) const;

  /// Writes; to be called only if judge() allowed it.
  void write(int address, std::span<const std::uint16_t> values);

  /// The command block as it would be after writing `values` from `address` on.
  Command command_after(int address, std::span<const std::uint16_t> values) const;
  std::uint16_t heartbeat_after(int address, std::span<const std::uint16_t> values) const;

  std::span<std::uint16_t> input() { return input_; }
  std::span<std::uint16_t> holding() { return holding_; }

 private:
  void put(std::string_view name, double value);
  double held(std::string_view name, std::span<const std::uint16_t> holding) const;
  std::vector<std::uint16_t> holding_after(int address,
                                           std::span<const std::uint16_t> values) const;
  static bool covers(const bridge::RegisterEntry& entry, int address, int count);

  bridge::RegisterMap map_;
  std::vector<std::uint16_t> input_;
  std::vector<std::uint16_t> holding_;
};

}  // namespace biotomy::sim
