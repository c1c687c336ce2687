#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace biotomy::sim {

// Frames of Modbus RTU: unit (1), function (1), what belongs to it, check (2, low byte first).

/// The check over `bytes` (Modbus over Serial Line 1.02, 6.2.2): CRC-16, polynomial 0xA001.
std::uint16_t rtu_check(std::span<const std::uint8_t> bytes);

/// Whether the bytes are a whole frame with the right check.
bool is_rtu_frame(std::span<const std::uint8_t> bytes);

/// The length of the request that `bytes` begin with, as far as its function and its first bytes
/// tell it; 0 if they don't.
std::size_t rtu_request_length(std::span<const std::uint8_t> bytes);

}  // namespace biotomy::sim
