#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "firmware_bridge/wire/endpoint.hpp"
#include "firmware_bridge/wire/serial_line.hpp"
#include "sim/control/controller_port.hpp"

namespace biotomy::sim {

/// The controller's Modbus side, over one kind of line. What it answers is the same over each: see
/// ModbusRequests.
class ModbusServer {
 public:
  virtual ~ModbusServer() = default;

  /// Where a master reaches it: "tcp://127.0.0.1:1502" with the port that was found, or
  /// "rtu:///path".
  virtual const std::string& address() const = 0;

  /// Serves until stopped, and ends within a tenth of a second then.
  virtual void run(const std::stop_token& stop) = 0;
};

/// Listens at once. Throws std::runtime_error (one line) if the address can't be had.
std::unique_ptr<ModbusServer> make_modbus_server(const bridge::Endpoint& listen,
                                                 const bridge::SerialFormat& serial,
                                                 const bridge::RegisterMap& map,
                                                 ControllerPort& controller);

}  // namespace biotomy::sim
