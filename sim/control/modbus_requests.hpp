#pragma once

#include <cstdint>
#include <span>

#include <modbus/modbus.h>

#include "sim/control/controller_port.hpp"

namespace biotomy::sim {

/// What the controller does with a Modbus request, whatever line it came over. Functions 3, 4, 6
/// and 16; whatever else comes is answered by a Modbus exception: 1 another function, 2 registers
/// that are not there or not to be written, 3 a request that contradicts itself, 6 a command while
/// one runs.
class ModbusRequests {
 public:
  ModbusRequests(const bridge::RegisterMap& map, ControllerPort& controller);

  /// Carries a request out and sends the answer over `context`. `frame` is all that came, `body`
  /// the part of it from the function code on, without a check at the end. A controller that does
  /// not answer lets the request fall. False if the answer could not be sent.
  bool answer(modbus_t* context, std::span<const std::uint8_t> frame,
              std::span<const std::uint8_t> body);

 private:
  int judge(std::span<const std::uint8_t> body);
  int take_write(int address, std::span<const std::uint16_t> values);

  ControllerRegisters registers_;
  ControllerPort& controller_;
};

}  // namespace biotomy::sim
