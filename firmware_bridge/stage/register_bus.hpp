#pragma once

#include <cstdint>
#include <span>

#include "firmware_bridge/wire/register_map.hpp"

namespace biotomy::bridge {

/// Registers of one controller, read and written in blocks. Every call throws DeviceError.
class RegisterBus {
 public:
  virtual ~RegisterBus() = default;

  /// Reads registers.size() (1 to 125) registers from `address` in one request.
  virtual void read(RegisterTable table, int address, std::span<std::uint16_t> registers) = 0;

  /// Writes 1 to 123 holding registers from `address` in one request (function 16). After a
  /// time-out they may have been written or not; it is never tried again here.
  virtual void write(int address, std::span<const std::uint16_t> registers) = 0;
};

}  // namespace biotomy::bridge
