#include "sim/control/modbus_server.hpp"

#include "sim/control/modbus_rtu_server.hpp"
#include "sim/control/modbus_tcp_server.hpp"

namespace biotomy::sim {

std::unique_ptr<ModbusServer> make_modbus_server(const bridge::Endpoint& listen,
                                                 const bridge::SerialFormat& serial,
                                                 const bridge::RegisterMap& map,
                                                 ControllerPort& controller) {
  if (listen.scheme == bridge::Endpoint::Scheme::rtu) {
    return std::make_unique<ModbusRtuServer>(listen.path, serial, map, controller);
  }
  return std::make_unique<ModbusTcpServer>(listen, map, controller);
}

}  // namespace biotomy::sim
