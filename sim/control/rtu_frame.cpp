#include "sim/control/rtu_frame.hpp"

#include <modbus/modbus.h>

namespace biotomy::sim {

namespace {

constexpr std::uint16_t kPolynomial = 0xA001;
constexpr std::size_t kCheck = 2;
constexpr std::size_t kLeastFrame = 4;
constexpr std::size_t kShortRequest = 8;  // functions 3, 4 and 6
constexpr std::size_t kByteCountAt = 6;   // in function 16

}  // namespace

std::uint16_t rtu_check(std::span<const std::uint8_t> bytes) {
  std::uint16_t check = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    check ^= byte;
    for (int bit = 0; bit < 8; ++bit) {
      const bool carry = (check & 1U) != 0;
      check = static_cast<std::uint16_t>((check >> 1U) ^ (carry ? kPolynomial : 0U));
    }
  }
  return check;
}

bool is_rtu_frame(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kLeastFrame) {
    return false;
  }
  const std::size_t end = bytes.size() - kCheck;
  const std::uint16_t check = rtu_check(bytes.first(end));
  return bytes[end] == (check & 0xFFU) && bytes[end + 1] == check >> 8U;
}

std::size_t rtu_request_length(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 2) {
    return 0;
  }
  switch (bytes[1]) {
    case MODBUS_FC_READ_HOLDING_REGISTERS:
    case MODBUS_FC_READ_INPUT_REGISTERS:
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
      return kShortRequest;
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      return bytes.size() > kByteCountAt ? kByteCountAt + 1 + bytes[kByteCountAt] + kCheck : 0;
    default:
      return 0;
  }
}

}  // namespace biotomy::sim
