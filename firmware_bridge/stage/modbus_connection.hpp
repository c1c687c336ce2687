#pragma once

#include <chrono>
#include <memory>

#include <modbus/modbus.h>

#include "firmware_bridge/wire/serial_line.hpp"
#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::bridge {

/// An open way to a Modbus slave: the descriptor, which is opened and closed here, and libmodbus's
/// context over it, which frames, checks and waits for an answer, but never recovers by itself.
class ModbusConnection {
 public:
  /// Over a connected socket. Throws std::system_error.
  static std::unique_ptr<ModbusConnection> over_tcp(UniqueFd socket, int unit_id,
                                                    std::chrono::milliseconds response_timeout);

  /// Over an open serial line. Throws std::system_error.
  static std::unique_ptr<ModbusConnection> over_serial(UniqueFd line, const SerialFormat& format,
                                                       int unit_id,
                                                       std::chrono::milliseconds response_timeout);

  /// Closes without waiting for anything.
  ~ModbusConnection();
  ModbusConnection(const ModbusConnection&) = delete;
  ModbusConnection& operator=(const ModbusConnection&) = delete;

  modbus_t* context() { return context_.get(); }

  /// Whether something has come that nobody asked for, or the other side has closed.
  bool has_unasked_bytes() const;

  /// Waits for `silence` without a byte, throwing away what comes; false if the line isn't silent
  /// before `limit`.
  bool wait_for_silence(std::chrono::microseconds silence, std::chrono::microseconds limit) const;

 private:
  struct ContextDeleter {
    void operator()(modbus_t* context) const { modbus_free(context); }
  };
  ModbusConnection(UniqueFd descriptor, modbus_t* context, bool is_serial, int unit_id,
                   std::chrono::milliseconds response_timeout);

  UniqueFd descriptor_;
  std::unique_ptr<modbus_t, ContextDeleter> context_;
  bool is_serial_;
};

}  // namespace biotomy::bridge
