#include "sim/control/controller_registers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "firmware_bridge/wire/register_codec.hpp"

namespace biotomy::sim {

namespace {

using bridge::RegisterEntry;
using bridge::RegisterTable;
using bridge::RegisterType;

constexpr double kMapMagic = 0xB107;

constexpr std::array kInputNames = {
    "map_magic",         "map_version",         "controller_state",
    "fault_code",        "interlocks",          "controller_heartbeat",
    "watchdog_timeout",  "command_result",      "sequence_started",
    "sequence_finished", "grind_count",         "feed_position",
    "traverse_position", "column_position",     "ground_position",
    "spindle_speed",     "spindle_load",        "vibration",
    "block_temperature", "chamber_temperature", "outputs",
    "feed_target",       "traverse_target",     "column_target",
    "feed_minimum",      "feed_maximum",        "traverse_minimum",
    "traverse_maximum",  "column_minimum",      "column_maximum"};

constexpr std::array kHoldingNames = {
    "daemon_heartbeat", "command", "argument_position", "argument_duration", "argument_spindle",
    "sequence",         "echo"};

void check(const bridge::RegisterMap& map, const char* name, RegisterTable table) {
  const RegisterEntry& entry = map.at(name);
  if (entry.table != table) {
    throw bridge::ConfigurationError(map.source() + ": the twin serves " + name + " as " +
                                     bridge::to_string(table) + " register, the map has it as " +
                                     bridge::to_string(entry.table));
  }
}

/// The value nearest to `value` that the register holds: an overrun meter shows its end stop.
double clamped(const RegisterEntry& entry, double value) {
  const auto within = [&](double least, double most) {
    return std::clamp(value, least * entry.scale, most * entry.scale);
  };
  switch (entry.type) {
    case RegisterType::u16:
      return within(0, std::numeric_limits<std::uint16_t>::max());
    case RegisterType::i16:
      return within(std::numeric_limits<std::int16_t>::min(),
                    std::numeric_limits<std::int16_t>::max());
    case RegisterType::u32:
      return within(0, std::numeric_limits<std::uint32_t>::max());
    case RegisterType::i32:
      return within(std::numeric_limits<std::int32_t>::min(),
                    std::numeric_limits<std::int32_t>::max());
    case RegisterType::f32:
      break;
  }
  return value;
}

double bits(std::initializer_list<bool> flags) {
  double sum = 0;
  double weight = 1;
  for (const bool flag : flags) {
    sum += flag ? weight : 0;
    weight *= 2;
  }
  return sum;
}

}  // namespace

ControllerRegisters::ControllerRegisters(const bridge::RegisterMap& map)
    : map_(map),
      input_(static_cast<std::size_t>(map.extent(RegisterTable::input))),
      holding_(static_cast<std::size_t>(map.extent(RegisterTable::holding))) {
  for (const char* name : kInputNames) {
    check(map, name, RegisterTable::input);
  }
  for (const char* name : kHoldingNames) {
    check(map, name, RegisterTable::holding);
  }
}

void ControllerRegisters::put(std::string_view name, double value) {
  const RegisterEntry& entry = map_.at(name);
  bridge::encode(entry, clamped(entry, value),
                 std::span(input_).subspan(static_cast<std::size_t>(entry.address)));
}

void ControllerRegisters::show(const ControllerReading& reading) {
  put("map_magic", kMapMagic);
  put("map_version", map_.version());
  put("controller_state", static_cast<double>(reading.status.state));
  put("fault_code", static_cast<double>(reading.status.fault));
  put("interlocks", bits({reading.status.estop_pressed, reading.status.door_open,
                          reading.status.watchdog_tripped, reading.status.homed}));
  put("controller_heartbeat", reading.status.heartbeat);
  put("watchdog_timeout", static_cast<double>(reading.settings.watchdog_timeout.count()));
  put("command_result", static_cast<double>(reading.memory.result));
  put("sequence_started", reading.memory.sequence_started);
  put("sequence_finished", reading.memory.sequence_finished);
  put("grind_count", reading.memory.grind_count);
  put("feed_position", reading.feed_um);
  put("traverse_position", reading.traverse_um);
  put("column_position", reading.column_um);
  put("ground_position", reading.memory.ground_position_um);
  put("spindle_speed", reading.spindle_rpm);
  put("spindle_load", reading.spindle_load_percent);
  put("vibration", reading.vibration_mm_s);
  put("block_temperature", reading.block_temperature_c);
  put("chamber_temperature", reading.chamber_temperature_c);
  put("outputs", bits({reading.coolant_on, reading.air_on}));
  put("feed_target", reading.feed_target_um);
  put("traverse_target", reading.traverse_target_um);
  put("column_target", reading.column_target_um);
  put("feed_minimum", reading.settings.feed_minimum_um);
  put("feed_maximum", reading.settings.feed_maximum_um);
  put("traverse_minimum", reading.traverse_minimum_um);
  put("traverse_maximum", reading.traverse_maximum_um);
  put("column_minimum", reading.settings.column_minimum_um);
  put("column_maximum", reading.settings.column_maximum_um);
}

bool ControllerRegisters::covers(const RegisterEntry& entry, int address, int count) {
  return entry.table == RegisterTable::holding && entry.address >= address &&
         entry.end() <= address + count;
}

RegisterWrite ControllerRegisters::judge(int address, int count) const {
  RegisterWrite write;
  int writable = 0;
  for (const RegisterEntry& entry : map_.entries()) {
    if (covers(entry, address, count) && entry.access != bridge::RegisterAccess::read) {
      writable += entry.width();
    }
  }
  // Half of a 32-bit value is covered by no entry, so it is not writable by itself.
  write.allowed = count > 0 && writable == count;
  write.heartbeat = covers(map_.at("daemon_heartbeat"), address, count);
  write.command = covers(map_.at("sequence"), address, count);
  return write;
}

void ControllerRegisters::write(int address, std::span<const std::uint16_t> values) {
  std::ranges::copy(values, holding_.begin() + address);
}

std::vector<std::uint16_t> ControllerRegisters::holding_after(
    int address, std::span<const std::uint16_t> values) const {
  std::vector<std::uint16_t> holding = holding_;
  std::ranges::copy(values, holding.begin() + address);
  return holding;
}

double ControllerRegisters::held(std::string_view name,
                                 std::span<const std::uint16_t> holding) const {
  const RegisterEntry& entry = map_.at(name);
  return bridge::decode(entry, holding.subspan(static_cast<std::size_t>(entry.address)));
}

Command ControllerRegisters::command_after(int address,
                                           std::span<const std::uint16_t> values) const {
  const std::vector<std::uint16_t> holding = holding_after(address, values);
  Command command;
  command.sequence = static_cast<std::uint32_t>(held("sequence", holding));
  command.action = static_cast<std::uint16_t>(held("command", holding));
  command.position_um = held("argument_position", holding);
  command.duration_ms = held("argument_duration", holding);
  command.spindle_rpm = held("argument_spindle", holding);
  return command;
}

std::uint16_t ControllerRegisters::heartbeat_after(int address,
                                                   std::span<const std::uint16_t> values) const {
  return static_cast<std::uint16_t>(held("daemon_heartbeat", holding_after(address, values)));
}

}  // namespace biotomy::sim
