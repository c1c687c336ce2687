#pragma once

#include <memory>
#include <vector>

#include "firmware_bridge/stage/register_bus.hpp"
#include "firmware_bridge/stage/stage.hpp"
#include "firmware_bridge/wire/register_blocks.hpp"
#include "firmware_bridge/wire/register_map.hpp"

namespace biotomy::bridge {

/// A grinding stage behind Modbus registers, at the addresses that a register map gives.
///
/// exchange() is one write and, with the status in one block of the map, one read, so that the
/// snapshot is of one moment. issue() is a single write of the whole command, its sequence number
/// last: the controller sees all of it or nothing.
class ModbusStage final : public Stage {
 public:
  /// Checks the map: throws ConfigurationError if it lacks a name, if a status value can't be read
  /// or a command value can't be written, or if the command's registers aren't one block.
  ModbusStage(RegisterMap map, std::unique_ptr<RegisterBus> bus);

  /// Throws DeviceError (configuration) if map_magic or map_version are not those of the map.
  StageIdentity identify() override;
  StageStatus look() override;
  StageStatus exchange(std::uint16_t heartbeat) override;

  /// Throws DeviceError (refused), before anything is sent, for a position, duration or speed that
  /// its register cannot hold.
  void issue(std::uint32_t sequence, const StageCommand& command) override;

 private:
  class Snapshot;
  Snapshot read(const std::vector<RegisterBlock>& blocks);

  RegisterMap map_;
  std::unique_ptr<RegisterBus> bus_;
  std::vector<RegisterBlock> identity_blocks_;
  std::vector<RegisterBlock> status_blocks_;
  RegisterBlock command_block_;
};

}  // namespace biotomy::bridge
