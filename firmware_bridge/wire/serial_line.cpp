#include "firmware_bridge/wire/serial_line.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>

#include "firmware_bridge/wire/checked_table.hpp"

namespace biotomy::bridge {

namespace {

constexpr int kDataBits = 8;

struct Speed {
  int baud;
  speed_t code;
};
constexpr Speed kSpeeds[] = {{1200, B1200},     {2400, B2400},     {4800, B4800},
                             {9600, B9600},     {19200, B19200},   {38400, B38400},
                             {57600, B57600},   {115200, B115200}, {230400, B230400},
                             {460800, B460800}, {500000, B500000}, {921600, B921600}};

const Speed* speed_of(int baud) {
  for (const Speed& speed : kSpeeds) {
    if (speed.baud == baud) return &speed;
  }
  return nullptr;
}

std::string speeds_text() {
  std::string text;
  for (const Speed& speed : kSpeeds) {
    text.append(text.empty() ? "" : ", ").append(std::to_string(speed.baud));
  }
  return text;
}

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

/// Majors of the far ends of pseudo-terminals (Linux, Documentation/admin-guide/devices.txt).
bool is_pseudo_terminal(int line) {
  struct stat status {};
  return fstat(line, &status) == 0 && major(status.st_rdev) >= 136 && major(status.st_rdev) <= 143;
}

void set_up(int line, const std::string& device, const SerialFormat& format) {
  termios attributes{};
  if (tcgetattr(line, &attributes) != 0) fail(errno, device);
  cfmakeraw(&attributes);
  attributes.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | PARENB | PARODD | CSIZE | CRTSCTS);
  attributes.c_cflag |= CLOCAL | CREAD | CS8;
  if (format.stop_bits == 2) attributes.c_cflag |= CSTOPB;
  // A pseudo-terminal has no wire for a parity bit, and refuses to be asked for one.
  if (format.parity != SerialFormat::Parity::none && !is_pseudo_terminal(line)) {
    // A character with a wrong parity bit becomes 0, which the frame's check finds.
    attributes.c_cflag |= PARENB;
    attributes.c_iflag |= INPCK;
  }
  if (format.parity == SerialFormat::Parity::odd) attributes.c_cflag |= PARODD;
  // So a read of nothing is EAGAIN, and 0 means that the device is gone.
  attributes.c_cc[VMIN] = 1;
  attributes.c_cc[VTIME] = 0;
  const Speed* speed = speed_of(format.baud);
  if (speed == nullptr) fail(EINVAL, device + ": " + std::to_string(format.baud) + " baud");
  if (cfsetispeed(&attributes, speed->code) != 0 || cfsetospeed(&attributes, speed->code) != 0 ||
      tcsetattr(line, TCSANOW, &attributes) != 0) {
    fail(errno, device);
  }
}

}  // namespace

std::chrono::microseconds SerialFormat::duration_of(std::size_t characters) const {
  const int bits = 1 + kDataBits + (parity == Parity::none ? 0 : 1) + stop_bits;
  return std::chrono::microseconds(1000000LL * static_cast<long long>(characters) * bits / baud);
}

std::chrono::microseconds SerialFormat::silence_between_frames() const {
  return baud > 19200 ? std::chrono::microseconds(1750) : duration_of(7) / 2;
}

SerialFormat read_serial_format(const CheckedTable& table) {
  SerialFormat format;
  format.baud = static_cast<int>(table.get(
      IntegerKey{.name = "baud",
                 .fallback = format.baud,
                 .minimum = 1200,
                 .maximum = 921600,
                 .description = "of a serial line; the default is what every Modbus device offers, "
                                "115200 is better where the controller has it"}));
  if (speed_of(format.baud) == nullptr) {
    table.reject(
        "baud", std::to_string(format.baud) + " is not possible; expected one of " + speeds_text());
  }
  const std::string parity = table.get(TextKey{.name = "parity",
                                               .fallback = "even",
                                               .choices = {"none", "even", "odd"},
                                               .description = "of a serial line"});
  format.parity = parity == "none"  ? SerialFormat::Parity::none
                  : parity == "odd" ? SerialFormat::Parity::odd
                                    : SerialFormat::Parity::even;
  format.stop_bits = static_cast<int>(
      table.get(IntegerKey{.name = "stop_bits",
                           .fallback = format.stop_bits,
                           .minimum = 1,
                           .maximum = 2,
                           .description = "of a serial line; without parity Modbus wants 2"}));
  return format;
}

UniqueFd open_serial_line(const std::string& device, const SerialFormat& format) {
  UniqueFd line(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!line.valid()) fail(errno, device);
  if (flock(line.get(), LOCK_EX | LOCK_NB) != 0) fail(errno, device);
  set_up(line.get(), device, format);
  discard_pending(line.get());
  return line;
}

void discard_pending(int line) {
  // On a device that is gone there is nothing to be thrown away.
  static_cast<void>(tcflush(line, TCIOFLUSH));
}

void close_serial_line(UniqueFd& line) {
  if (line.valid()) discard_pending(line.get());
  line.reset();
}

}  // namespace biotomy::bridge
