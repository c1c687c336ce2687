#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::bridge {

class CheckedTable;

/// How characters go over a serial line; eight data bits, as Modbus RTU wants them.
/// The defaults are those that every Modbus device has to offer (Modbus over Serial Line 1.02,
/// 2.5.1 and 3.3: 19200 baud, even parity, one stop bit).
struct SerialFormat {
  enum class Parity { none, even, odd };

  int baud = 19200;
  Parity parity = Parity::even;
  int stop_bits = 1;

  /// How long so many characters are on their way.
  std::chrono::microseconds duration_of(std::size_t characters) const;

  /// The silence that parts two frames: 3.5 characters, above 19200 baud 1.75 ms (2.5.1.1).
  std::chrono::microseconds silence_between_frames() const;
};

/// The most characters in a frame of Modbus RTU, its check included (2.5.1).
inline constexpr std::size_t kMostCharactersInAFrame = 256;

/// Reads "baud", "parity" and "stop_bits". Throws ConfigurationError.
SerialFormat read_serial_format(const CheckedTable& table);

/// Opens a serial device for raw bytes, non-blocking, and throws away what it still held. The line
/// is locked (flock) against a second program of ours. Never waits for a carrier.
/// Throws std::system_error: ENODEV or ENOENT for a device that is not there, EWOULDBLOCK for one
/// that is locked, ENOTTY for a file that is no serial device.
UniqueFd open_serial_line(const std::string& device, const SerialFormat& format);

/// Throws away what was received and not read, and what was written and is not sent yet.
void discard_pending(int line);

/// Closes the line without waiting for what is not sent yet, which close() alone does for up to
/// half a minute.
void close_serial_line(UniqueFd& line);

}  // namespace biotomy::bridge
