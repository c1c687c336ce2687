#include "tests/kernel/cable.hpp"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <system_error>

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

namespace biotomy::tests {

namespace {

/// The lengths of both texts, before them.
using Lengths = std::array<std::uint32_t, 2>;

void check(bool good, const std::string& what) {
  if (!good) throw std::system_error(errno, std::generic_category(), what);
}

bridge::UniqueFd open_raw(const std::filesystem::path& terminal) {
  bridge::UniqueFd opened(open(terminal.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  check(opened.valid(), terminal);
  termios settings{};
  check(tcgetattr(opened.get(), &settings) == 0, terminal);
  cfmakeraw(&settings);
  check(tcsetattr(opened.get(), TCSANOW, &settings) == 0, terminal);
  return opened;
}

}  // namespace

Cable Cable::at(const std::filesystem::path& terminal) {
  return Cable(open_raw(terminal));
}

Cable Cable::make() {
  Cable cable(bridge::UniqueFd(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)));
  const int near_end = cable.terminal_.get();
  check(near_end >= 0 && grantpt(near_end) == 0 && unlockpt(near_end) == 0, "a pseudo-terminal");
  cable.far_end_ = ptsname(near_end);
  cable.kept_open_ = open_raw(cable.far_end_);
  return cable;
}

void Cable::send(const CablePacket& packet) const {
  const Lengths lengths{static_cast<std::uint32_t>(packet.text.size()),
                        static_cast<std::uint32_t>(packet.file.size())};
  send_bytes(lengths.data(), sizeof lengths);
  send_bytes(packet.text.data(), packet.text.size());
  send_bytes(packet.file.data(), packet.file.size());
}

CablePacket Cable::receive() const {
  Lengths lengths{};
  receive_bytes(lengths.data(), sizeof lengths);
  CablePacket packet{.text = std::string(lengths[0], '\0'), .file = std::string(lengths[1], '\0')};
  receive_bytes(packet.text.data(), packet.text.size());
  receive_bytes(packet.file.data(), packet.file.size());
  return packet;
}

void Cable::send_bytes(const void* data, std::size_t size) const {
  const auto* next = static_cast<const std::byte*>(data);
  while (size > 0) {
    const ssize_t sent = write(terminal_.get(), next, size);
    if (sent < 0 && errno == EINTR) continue;
    check(sent > 0, "the cable");
    next += sent;
    size -= static_cast<std::size_t>(sent);
  }
}

void Cable::receive_bytes(void* data, std::size_t size) const {
  auto* next = static_cast<std::byte*>(data);
  while (size > 0) {
    const ssize_t received = read(terminal_.get(), next, size);
    if (received < 0 && errno == EINTR) continue;
    check(received > 0, "the cable");
    next += received;
    size -= static_cast<std::size_t>(received);
  }
}

}  // namespace biotomy::tests
