#include "firmware_bridge/stage/modbus_stage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/wire/register_codec.hpp"

namespace biotomy::bridge {

namespace {

using Kind = DeviceError::Kind;

constexpr std::uint16_t kMapMagic = 0xB107;

const std::vector<std::string> kIdentityNames = {
    "map_magic",        "map_version",      "watchdog_timeout", "feed_minimum",  "feed_maximum",
    "traverse_minimum", "traverse_maximum", "column_minimum",   "column_maximum"};

const std::vector<std::string> kStatusNames = {
    "controller_state",    "fault_code",        "interlocks",        "controller_heartbeat",
    "command_result",      "sequence_started",  "sequence_finished", "grind_count",
    "feed_position",       "traverse_position", "column_position",   "ground_position",
    "spindle_speed",       "spindle_load",      "vibration",         "block_temperature",
    "chamber_temperature", "outputs",           "feed_target",       "traverse_target",
    "column_target"};

const std::vector<std::string> kCommandNames = {"command", "argument_position", "argument_duration",
                                                "argument_spindle", "sequence"};

void check_readable(const RegisterMap& map, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (map.at(name).access == RegisterAccess::write) {
      throw ConfigurationError(map.source() + ": registers." + name +
                               ": must be readable, access \"r\" or \"rw\"");
    }
  }
}

void check_writable(const RegisterMap& map, const std::string& name) {
  const RegisterEntry& entry = map.at(name);
  if (entry.table != RegisterTable::holding || entry.access == RegisterAccess::read) {
    throw ConfigurationError(map.source() + ": registers." + name +
                             ": must be a holding register with access \"w\" or \"rw\"");
  }
}

/// These hold codes, counts and bits: scaled or as floats they would lose what they say.
void check_unscaled(const RegisterMap& map, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const RegisterEntry& entry = map.at(name);
    if (entry.scale != 1.0 || entry.type == RegisterType::f32) {
      throw ConfigurationError(map.source() + ": registers." + name +
                               ": must be an integer with scale 1");
    }
  }
}

/// A counter that ends early would end the run: the heartbeat takes every number of 16 bits, and
/// the others count for as long as a controller lives.
void check_wide_enough(const RegisterMap& map) {
  for (const char* name : {"daemon_heartbeat", "controller_heartbeat"}) {
    if (map.at(name).type == RegisterType::i16) {
      throw ConfigurationError(map.source() + ": registers." + name +
                               ": must hold 0 to 65535: type u16, u32 or i32");
    }
  }
  for (const char* name : {"sequence", "sequence_started", "sequence_finished", "grind_count"}) {
    if (map.at(name).width() != 2) {
      throw ConfigurationError(map.source() + ": registers." + name +
                               ": must have 32 bits: type u32 or i32");
    }
  }
}

/// The one block of the command; a hole or another register in it would be overwritten with 0.
RegisterBlock command_block(const RegisterMap& map) {
  std::vector<const RegisterEntry*> entries;
  for (const std::string& name : kCommandNames) {
    check_writable(map, name);
    entries.push_back(&map.at(name));
  }
  std::sort(entries.begin(), entries.end(),
            [](const auto* a, const auto* b) { return a->address < b->address; });
  for (std::size_t i = 1; i < entries.size(); ++i) {
    if (entries[i]->address != entries[i - 1]->end()) {
      throw ConfigurationError(map.source() + ": registers." + entries[i]->name + ": must follow " +
                               entries[i - 1]->name +
                               " without a gap, since one request carries the whole command");
    }
  }
  if (entries.back()->name != "sequence") {
    throw ConfigurationError(map.source() +
                             ": registers.sequence: must be the last register of "
                             "the command, after its arguments");
  }
  const int first = entries.front()->address;
  return {RegisterTable::holding, first, entries.back()->end() - first};
}

std::string number(double value) {
  return std::to_string(std::llround(value));
}

}  // namespace

/// The registers of some blocks as they were read, given out by name.
class ModbusStage::Snapshot {
 public:
  explicit Snapshot(const RegisterMap& map) : map_(map) {}

  void add(const RegisterBlock& block, std::vector<std::uint16_t> registers) {
    parts_.emplace_back(block, std::move(registers));
  }

  double value(const std::string& name) const {
    const RegisterEntry& entry = map_.at(name);
    for (const auto& [block, registers] : parts_) {
      if (!block.holds(entry)) continue;
      const auto offset = static_cast<std::size_t>(entry.address - block.address);
      const double value = decode(entry, std::span(registers).subspan(offset));
      if (!std::isfinite(value)) {
        throw DeviceError(Kind::refused, "stage: register " + name + " holds no number");
      }
      return value;
    }
    throw std::logic_error("register " + name + " was not read");
  }

  Micrometres position(const std::string& name) const { return {value(name)}; }

  /// An unscaled integer; one that its type here can't hold is the controller's mistake.
  template <class Integer>
  Integer integer(const std::string& name) const {
    const double found = value(name);
    if (found < 0 || found > static_cast<double>(std::numeric_limits<Integer>::max())) {
      throw DeviceError(Kind::refused, "stage: register " + name + " holds " + number(found) +
                                           ", which it never should");
    }
    return static_cast<Integer>(found);
  }

  template <class Enumeration>
  Enumeration code(const std::string& name, Enumeration last) const {
    const auto found = integer<std::uint16_t>(name);
    if (found > static_cast<std::uint16_t>(last)) {
      throw DeviceError(Kind::refused, "stage: register " + name + " holds the unknown code " +
                                           std::to_string(found) +
                                           "; does the register map fit this controller?");
    }
    return static_cast<Enumeration>(found);
  }

 private:
  const RegisterMap& map_;
  std::vector<std::pair<RegisterBlock, std::vector<std::uint16_t>>> parts_;
};

ModbusStage::ModbusStage(RegisterMap map, std::unique_ptr<RegisterBus> bus)
    : map_(std::move(map)), bus_(std::move(bus)) {
  check_readable(map_, kIdentityNames);
  check_readable(map_, kStatusNames);
  check_writable(map_, "daemon_heartbeat");
  check_readable(map_, {"echo"});
  check_writable(map_, "echo");
  if (map_.at("echo").width() != 1) {
    throw ConfigurationError(map_.source() + ": registers.echo: must be one register");
  }
  check_unscaled(map_,
                 {"map_magic", "map_version", "controller_state", "fault_code", "interlocks",
                  "controller_heartbeat", "command_result", "sequence_started", "sequence_finished",
                  "grind_count", "outputs", "daemon_heartbeat", "command", "sequence", "echo"});
  check_wide_enough(map_);
  command_block_ = command_block(map_);
  identity_blocks_ = plan_reads(map_, kIdentityNames);
  status_blocks_ = plan_reads(map_, kStatusNames);
}

ModbusStage::Snapshot ModbusStage::read(const std::vector<RegisterBlock>& blocks) {
  Snapshot snapshot(map_);
  for (const RegisterBlock& block : blocks) {
    std::vector<std::uint16_t> registers(static_cast<std::size_t>(block.count));
    bus_->read(block.table, block.address, registers);
    snapshot.add(block, std::move(registers));
  }
  return snapshot;
}

StageIdentity ModbusStage::identify() {
  const Snapshot snapshot = read(identity_blocks_);
  const auto magic = snapshot.integer<std::uint16_t>("map_magic");
  if (magic != kMapMagic) {
    throw DeviceError(Kind::configuration, "stage: map_magic is " + std::to_string(magic) +
                                               ", expected " + std::to_string(kMapMagic) +
                                               ": no controller with the registers of " +
                                               map_.source());
  }
  StageIdentity identity;
  identity.map_version = snapshot.integer<std::uint16_t>("map_version");
  if (identity.map_version != map_.version()) {
    throw DeviceError(Kind::configuration,
                      "stage: the controller has version " + std::to_string(identity.map_version) +
                          " of the register map, " + map_.source() + " is version " +
                          std::to_string(map_.version()) + "; use the matching map");
  }
  identity.watchdog_timeout =
      std::chrono::milliseconds(std::llround(snapshot.value("watchdog_timeout")));
  identity.feed = {snapshot.position("feed_minimum"), snapshot.position("feed_maximum")};
  identity.traverse = {snapshot.position("traverse_minimum"),
                       snapshot.position("traverse_maximum")};
  identity.column = {snapshot.position("column_minimum"), snapshot.position("column_maximum")};
  return identity;
}

StageStatus ModbusStage::exchange(std::uint16_t heartbeat) {
  const RegisterEntry& beat = map_.at("daemon_heartbeat");
  std::vector<std::uint16_t> registers(static_cast<std::size_t>(beat.width()));
  encode(beat, heartbeat, registers);
  bus_->write(beat.address, registers);
  return look();
}

StageStatus ModbusStage::look() {
  const Snapshot snapshot = read(status_blocks_);
  const auto interlocks = snapshot.integer<std::uint16_t>("interlocks");
  const auto outputs = snapshot.integer<std::uint16_t>("outputs");
  StageStatus status;
  status.state = snapshot.code("controller_state", ControllerState::faulted);
  status.fault_code = snapshot.integer<std::uint16_t>("fault_code");
  status.interlocks = {.estop_pressed = (interlocks & 1U) != 0,
                       .door_open = (interlocks & 2U) != 0,
                       .watchdog_tripped = (interlocks & 4U) != 0,
                       .homed = (interlocks & 8U) != 0};
  status.controller_heartbeat = snapshot.integer<std::uint16_t>("controller_heartbeat");
  status.last_result = snapshot.code("command_result", CommandResult::aborted);
  status.sequence_started = snapshot.integer<std::uint32_t>("sequence_started");
  status.sequence_finished = snapshot.integer<std::uint32_t>("sequence_finished");
  status.grind_count = snapshot.integer<std::uint32_t>("grind_count");
  status.feed = snapshot.position("feed_position");
  status.traverse = snapshot.position("traverse_position");
  status.column = snapshot.position("column_position");
  status.feed_target = snapshot.position("feed_target");
  status.traverse_target = snapshot.position("traverse_target");
  status.column_target = snapshot.position("column_target");
  status.ground_to = snapshot.position("ground_position");
  status.spindle_rpm = snapshot.value("spindle_speed");
  status.spindle_load_percent = snapshot.value("spindle_load");
  status.vibration_mm_s = snapshot.value("vibration");
  status.block_temperature_c = snapshot.value("block_temperature");
  status.chamber_temperature_c = snapshot.value("chamber_temperature");
  status.coolant_on = (outputs & 1U) != 0;
  status.air_on = (outputs & 2U) != 0;
  return status;
}

void ModbusStage::issue(std::uint32_t sequence, const StageCommand& command) {
  std::vector<std::uint16_t> registers(static_cast<std::size_t>(command_block_.count));
  const auto put = [&](const char* name, double value) {
    const RegisterEntry& entry = map_.at(name);
    const auto offset = static_cast<std::size_t>(entry.address - command_block_.address);
    encode(entry, value, std::span(registers).subspan(offset));
  };
  try {
    put("command", static_cast<std::uint16_t>(command.action));
    put("argument_position", command.position.value);
    put("argument_duration", static_cast<double>(command.duration.count()));
    put("argument_spindle", command.spindle_rpm);
    put("sequence", sequence);
  } catch (const RegisterRangeError& error) {
    throw DeviceError(Kind::refused, std::string("stage: ") + to_string(command.action) +
                                         " was not sent: " + error.what());
  }
  bus_->write(command_block_.address, registers);
}

}  // namespace biotomy::bridge
