#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "firmware_bridge/stage/register_bus.hpp"

namespace biotomy::bridge {

struct ModbusLinkSettings {
  std::string endpoint;                             ///< "tcp://host:port"
  int unit_id = 1;                                  ///< 1 to 247; over TCP, 255 too
  std::chrono::milliseconds response_timeout{500};  ///< for a connection and for a whole answer
  int read_retries = 1;                             ///< more tries of a read that timed out
  std::chrono::milliseconds reconnect_delay{100};   ///< after a failure; doubles with each
  std::chrono::milliseconds reconnect_delay_max{5000};
};

/// One connection to a Modbus slave. It opens itself at the first call and again after a failure,
/// but not sooner than the back-off allows: until then a call fails at once with `disconnected`, so
/// that no call ever sleeps. A call lasts at most (2 + read_retries) × response_timeout.
///
/// After a time-out the connection is closed, so that a late answer can't be taken for the next
/// one's. Only reads are tried again; whether a write that timed out was done is for the caller to
/// read back. An exception reply (illegal function, address, value; busy) is `refused` and leaves
/// the connection open.
class ModbusLink final : public RegisterBus {
 public:
  using Clock = std::function<std::chrono::steady_clock::time_point()>;

  /// Does not connect yet. Throws ConfigurationError for an endpoint or a setting that can't be.
  explicit ModbusLink(const ModbusLinkSettings& settings,
                      Clock clock = std::chrono::steady_clock::now);
  ~ModbusLink() override;

  void read(RegisterTable table, int address, std::span<std::uint16_t> registers) override;
  void write(int address, std::span<const std::uint16_t> registers) override;

  bool connected() const;

 private:
  struct Connection;

  void connect();
  void connect_if_due();
  [[noreturn]] void fail(const std::string& request, int error);
  void disconnect_with_back_off();

  ModbusLinkSettings settings_;
  Clock clock_;
  std::unique_ptr<Connection> connection_;
  std::chrono::steady_clock::time_point not_before_;
  std::chrono::milliseconds back_off_{0};
};

}  // namespace biotomy::bridge
