#include "firmware_bridge/stage/modbus_connection.hpp"

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include <poll.h>
#include <sys/select.h>
#include <unistd.h>

namespace biotomy::bridge {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::microseconds;

constexpr int kDataBits = 8;

/// Whether there is something to read within `time`.
bool readable(int descriptor, microseconds time) {
  const timespec limit{.tv_sec = time.count() / 1000000, .tv_nsec = time.count() % 1000000 * 1000};
  pollfd waited{descriptor, POLLIN, 0};
  return ::ppoll(&waited, 1, &limit, nullptr) > 0;
}

}  // namespace

std::unique_ptr<ModbusConnection> ModbusConnection::over_tcp(
    UniqueFd socket, int unit_id, std::chrono::milliseconds response_timeout) {
  // The context's address is never used: the socket is connected already.
  modbus_t* context = modbus_new_tcp("127.0.0.1", MODBUS_TCP_DEFAULT_PORT);
  return std::unique_ptr<ModbusConnection>(
      new ModbusConnection(std::move(socket), context, false, unit_id, response_timeout));
}

std::unique_ptr<ModbusConnection> ModbusConnection::over_serial(
    UniqueFd line, const SerialFormat& format, int unit_id,
    std::chrono::milliseconds response_timeout) {
  const char parity = format.parity == SerialFormat::Parity::none   ? 'N'
                      : format.parity == SerialFormat::Parity::even ? 'E'
                                                                    : 'O';
  // The context's device is never opened: the line is open already.
  modbus_t* context =
      modbus_new_rtu("serial line", format.baud, parity, kDataBits, format.stop_bits);
  return std::unique_ptr<ModbusConnection>(
      new ModbusConnection(std::move(line), context, true, unit_id, response_timeout));
}

ModbusConnection::ModbusConnection(UniqueFd descriptor, modbus_t* context, bool is_serial,
                                   int unit_id, std::chrono::milliseconds response_timeout)
    : descriptor_(std::move(descriptor)), context_(context), is_serial_(is_serial) {
  if (!context_) throw std::system_error(errno, std::generic_category(), "libmodbus");
  // libmodbus before 3.1.12 waits with select(), which writes beyond its set for such a number.
  if (descriptor_.get() >= FD_SETSIZE) {
    throw std::system_error(EMFILE, std::generic_category(),
                            "this process has more than 1000 open files; look for what keeps them "
                            "open");
  }
  modbus_set_error_recovery(context, MODBUS_ERROR_RECOVERY_NONE);
  modbus_set_slave(context, unit_id);
  modbus_set_socket(context, descriptor_.get());
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(response_timeout);
  const microseconds rest = response_timeout - seconds;
  modbus_set_response_timeout(context, static_cast<std::uint32_t>(seconds.count()),
                              static_cast<std::uint32_t>(rest.count()));
  // Without a time-out from byte to byte the one above holds for the whole answer: a slave that
  // sends a byte now and then can't draw it out.
  modbus_set_byte_timeout(context, 0, 0);
}

ModbusConnection::~ModbusConnection() {
  if (is_serial_) close_serial_line(descriptor_);
}

bool ModbusConnection::has_unasked_bytes() const {
  return readable(descriptor_.get(), microseconds(0));
}

bool ModbusConnection::wait_for_silence(microseconds silence, microseconds limit) const {
  const Clock::time_point until = Clock::now() + limit;
  while (readable(descriptor_.get(), silence)) {
    std::array<char, kMostCharactersInAFrame> thrown_away{};
    const ssize_t count = ::read(descriptor_.get(), thrown_away.data(), thrown_away.size());
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) {
      return true;  // the line is gone: the next request says so
    }
    if (Clock::now() >= until) return false;
  }
  return true;
}

}  // namespace biotomy::bridge
