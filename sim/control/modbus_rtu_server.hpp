#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "sim/control/modbus_requests.hpp"
#include "sim/control/modbus_server.hpp"
#include "sim/control/pseudo_terminal.hpp"

namespace biotomy::sim {

/// Over a serial line. Requests to other units and frames with a wrong check are not answered, as
/// the specification wants it.
class ModbusRtuServer final : public ModbusServer {
 public:
  /// Opens `path` if it is a serial device, else makes a pseudo-terminal with a link there.
  ModbusRtuServer(const std::filesystem::path& path, const bridge::SerialFormat& format,
                  const bridge::RegisterMap& map, ControllerPort& controller);
  ~ModbusRtuServer() override;

  const std::string& address() const override { return address_; }

  /// Throws std::runtime_error if the device goes.
  void run(const std::stop_token& stop) override;

 private:
  struct ContextDeleter {
    void operator()(modbus_t* context) const { modbus_free(context); }
  };

  int line() const;
  void answer_front();
  bool answer(std::size_t length);
  void receive();

  std::string address_;
  std::optional<PseudoTerminal> terminal_;
  bridge::UniqueFd device_;
  std::unique_ptr<modbus_t, ContextDeleter> context_;
  std::uint8_t unit_;
  ModbusRequests requests_;
  std::vector<std::uint8_t> received_;
};

}  // namespace biotomy::sim
