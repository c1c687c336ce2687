#include "sim/control/modbus_rtu_server.hpp"

#include <array>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include <poll.h>
#include <unistd.h>

#include "sim/control/rtu_frame.hpp"

namespace biotomy::sim {

namespace {

constexpr int kPollMilliseconds = 50;
constexpr std::size_t kUnit = 1;
constexpr std::size_t kCheck = 2;

/// What is not a whole frame after so long never will be. Longer than the 3.5 characters of the
/// specification: a pseudo-terminal's reader may be woken late.
constexpr int kFrameEndMilliseconds = 10;

/// Not so a link to a pseudo-terminal: a killed twin left it, and the number may be another's now.
bool is_serial_device(const std::filesystem::path& path) {
  if (!std::filesystem::is_character_file(path)) {
    return false;
  }
  return !std::filesystem::is_symlink(path) ||
         std::filesystem::canonical(path).parent_path() != "/dev/pts";
}

}  // namespace

ModbusRtuServer::ModbusRtuServer(const std::filesystem::path& path,
                                 const bridge::SerialFormat& format, const bridge::RegisterMap& map,
                                 ControllerPort& controller)
    : address_("rtu://" + path.string()),
      // The context's device is never opened: only its answers are framed and checked by it.
      context_(modbus_new_rtu("serial line", format.baud, 'N', 8, format.stop_bits)),
      unit_(static_cast<std::uint8_t>(map.unit_id())),
      requests_(map, controller) {
  try {
    if (is_serial_device(path)) {
      device_ = bridge::open_serial_line(path, format);
    } else {
      terminal_.emplace(path);
    }
  } catch (const std::system_error& error) {
    throw std::runtime_error("stage.listen " + address_ + ": " + error.what() +
                             "; choose a serial device, or a path where a link can be made");
  }
  if (!context_) {
    throw std::runtime_error("stage.listen " + address_ + ": " + modbus_strerror(errno));
  }
  modbus_set_socket(context_.get(), line());
}

ModbusRtuServer::~ModbusRtuServer() = default;

int ModbusRtuServer::line() const {
  return terminal_ ? terminal_->descriptor() : device_.get();
}

void ModbusRtuServer::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    pollfd waited{line(), POLLIN, 0};
    const int ready =
        poll(&waited, 1, received_.empty() ? kPollMilliseconds : kFrameEndMilliseconds);
    if (ready > 0) {
      receive();
      answer_front();
    } else if (ready == 0 && !received_.empty()) {
      // The line is silent: what is here is all. A function of unknown length ends so, too.
      answer(received_.size());
      received_.clear();
    }
  }
}

void ModbusRtuServer::receive() {
  std::array<std::uint8_t, bridge::kMostCharactersInAFrame> chunk{};
  const ssize_t count = read(line(), chunk.data(), chunk.size());
  if (count > 0) {
    received_.insert(received_.end(), chunk.begin(), chunk.begin() + count);
  } else if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
    throw std::runtime_error("stage.listen " + address_ + ": the serial device is gone");
  }
}

/// Answers the whole requests at the front. Behind a damaged one nothing is understood until the
/// line has been silent.
void ModbusRtuServer::answer_front() {
  for (;;) {
    const std::size_t length = rtu_request_length(received_);
    if (length == 0 || received_.size() < length || !answer(length)) {
      return;
    }
    received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(length));
  }
}

/// Answers the first `length` bytes; false if they are no frame.
bool ModbusRtuServer::answer(std::size_t length) {
  const std::span<const std::uint8_t> frame = std::span(received_).first(length);
  if (!is_rtu_frame(frame)) {
    return false;
  }
  if (frame[0] == unit_) {
    // An answer that nobody fetches is lost, as on a wire.
    static_cast<void>(requests_.answer(context_.get(), frame,
                                       frame.subspan(kUnit, frame.size() - kUnit - kCheck)));
  }
  return true;
}

}  // namespace biotomy::sim
