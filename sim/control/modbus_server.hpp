#pragma once

#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>

#include "firmware_bridge/wire/endpoint.hpp"
#include "sim/control/controller_registers.hpp"

namespace biotomy::sim {

/// What the Modbus server needs of the rig. Called from the server's thread.
class ControllerPort {
 public:
  virtual ~ControllerPort() = default;
  /// False while nothing that comes is heard or answered.
  virtual bool answers() const = 0;
  virtual ControllerReading read() = 0;
  virtual void hear_master(std::uint16_t heartbeat) = 0;
  virtual Acceptance submit(const Command& command) = 0;
};

/// The controller's Modbus side over TCP, for several masters at once. Functions 3, 4, 6 and 16;
/// whatever else comes is answered by a Modbus exception: 1 another function, 2 registers that are
/// not there or not to be written, 3 a request that contradicts itself, 6 a command while one runs.
/// What is no Modbus at all ends that connection and no other.
class ModbusServer {
 public:
  /// Listens at once; port 0 is any free one. Throws std::runtime_error (one line) if the address
  /// can't be had.
  ModbusServer(const bridge::Endpoint& listen, const bridge::RegisterMap& map,
               ControllerPort& controller);
  ~ModbusServer();
  ModbusServer(const ModbusServer&) = delete;
  ModbusServer& operator=(const ModbusServer&) = delete;

  /// "tcp://127.0.0.1:1502", with the port that was found.
  const std::string& address() const;

  /// Serves until stopped, and ends within a tenth of a second then.
  void run(const std::stop_token& stop);

 private:
  struct Listener;
  std::unique_ptr<Listener> listener_;
  ControllerRegisters registers_;
  ControllerPort& controller_;

  void answer(int client, std::span<const std::uint8_t> request);
  int judge_request(std::span<const std::uint8_t> request);
  int take_write(int address, std::span<const std::uint16_t> values);
};

}  // namespace biotomy::sim
