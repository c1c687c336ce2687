#pragma once

#include "sim/control/modbus_requests.hpp"
#include "sim/control/modbus_server.hpp"

namespace biotomy::sim {

/// Over TCP, for several masters at once. What is no Modbus at all ends that connection and no
/// other.
class ModbusTcpServer final : public ModbusServer {
 public:
  /// Port 0 is any free one.
  ModbusTcpServer(const bridge::Endpoint& listen, const bridge::RegisterMap& map,
                  ControllerPort& controller);
  ~ModbusTcpServer() override;

  const std::string& address() const override;
  void run(const std::stop_token& stop) override;

 private:
  struct Listener;
  std::unique_ptr<Listener> listener_;
  ModbusRequests requests_;
};

}  // namespace biotomy::sim
