#include "sim/control/modbus_requests.hpp"

#include <vector>

namespace biotomy::sim {

namespace {

constexpr int kNoException = 0;

// From the function code on: function (1), address (2), count or value (2).
constexpr std::size_t kOneRegister = 5;
// And the number of bytes (1), before the values.
constexpr std::size_t kLeastOfWritingSeveral = 6;

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>((bytes[at] << 8) | bytes[at + 1]);
}

}  // namespace

ModbusRequests::ModbusRequests(const bridge::RegisterMap& map, ControllerPort& controller)
    : registers_(map), controller_(controller) {}

bool ModbusRequests::answer(modbus_t* context, std::span<const std::uint8_t> frame,
                            std::span<const std::uint8_t> body) {
  if (!controller_.answers()) {
    return true;
  }
  const int exception = judge(body);
  if (exception != kNoException) {
    return modbus_reply_exception(context, frame.data(), static_cast<unsigned int>(exception)) >= 0;
  }
  registers_.show(controller_.read());
  modbus_mapping_t mapping{};
  mapping.nb_input_registers = static_cast<int>(registers_.input().size());
  mapping.tab_input_registers = registers_.input().data();
  mapping.nb_registers = static_cast<int>(registers_.holding().size());
  mapping.tab_registers = registers_.holding().data();
  return modbus_reply(context, frame.data(), static_cast<int>(frame.size()), &mapping) >= 0;
}

/// The exception that a request is to be answered with; a write that is in order is carried out.
int ModbusRequests::judge(std::span<const std::uint8_t> body) {
  const int function = body[0];
  const bool reads =
      function == MODBUS_FC_READ_HOLDING_REGISTERS || function == MODBUS_FC_READ_INPUT_REGISTERS;
  if (!reads && function != MODBUS_FC_WRITE_SINGLE_REGISTER &&
      function != MODBUS_FC_WRITE_MULTIPLE_REGISTERS) {
    return MODBUS_EXCEPTION_ILLEGAL_FUNCTION;
  }
  const bool writes_several = function == MODBUS_FC_WRITE_MULTIPLE_REGISTERS;
  if (writes_several ? body.size() < kLeastOfWritingSeveral : body.size() != kOneRegister) {
    return MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE;
  }
  const int address = word_at(body, 1);
  const std::uint16_t second = word_at(body, 3);
  if (reads) {
    const bool fits = second >= 1 && second <= MODBUS_MAX_READ_REGISTERS;
    return fits ? kNoException : MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE;
  }
  if (function == MODBUS_FC_WRITE_SINGLE_REGISTER) {
    return take_write(address, std::span(&second, 1));
  }
  const std::size_t count = second;
  if (count < 1 || count > MODBUS_MAX_WRITE_REGISTERS ||
      body.size() != kLeastOfWritingSeveral + 2 * count || body[5] != 2 * count) {
    return MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE;
  }
  std::vector<std::uint16_t> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = word_at(body, kLeastOfWritingSeveral + 2 * i);
  }
  return take_write(address, values);
}

int ModbusRequests::take_write(int address, std::span<const std::uint16_t> values) {
  const RegisterWrite write = registers_.judge(address, static_cast<int>(values.size()));
  if (!write.allowed) {
    return MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS;
  }
  if (write.heartbeat) {
    controller_.hear_master(registers_.heartbeat_after(address, values));
  }
  if (write.command &&
      controller_.submit(registers_.command_after(address, values)) == Acceptance::busy) {
    return MODBUS_EXCEPTION_SLAVE_OR_SERVER_BUSY;
  }
  registers_.write(address, values);
  return kNoException;
}

}  // namespace biotomy::sim
