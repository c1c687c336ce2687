#pragma once

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace biotomy::tests {

/// Stands in for systemd: a datagram socket at a path, named to programs in the environment as
/// long as the object lives, and told by them what they tell systemd.
class NotifySocket {
 public:
  explicit NotifySocket(const std::filesystem::path& path, std::chrono::microseconds watchdog = {})
      : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.string().copy(address.sun_path, sizeof(address.sun_path) - 1);
    if (bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0) {
      throw std::runtime_error("no socket at " + path.string());
    }
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
    if (watchdog.count() > 0) setenv("WATCHDOG_USEC", std::to_string(watchdog.count()).c_str(), 1);
  }
  ~NotifySocket() {
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
    close(socket_);
  }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// The next message; empty when none comes within the time.
  std::string receive(std::chrono::milliseconds time) {
    pollfd wait{socket_, POLLIN, 0};
    if (poll(&wait, 1, static_cast<int>(time.count())) <= 0) return "";
    std::array<char, 8192> text{};
    const ssize_t count = recv(socket_, text.data(), text.size(), 0);
    return {text.data(), count > 0 ? static_cast<std::size_t>(count) : 0};
  }

  /// Reads on until a message has `part` in it; false when time is up.
  bool await(const std::string& part, std::chrono::seconds time) {
    const auto limit = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < limit) {
      if (receive(std::chrono::milliseconds(100)).find(part) != std::string::npos) return true;
    }
    return false;
  }

 private:
  int socket_;
};

}  // namespace biotomy::tests
