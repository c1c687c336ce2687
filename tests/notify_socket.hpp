#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace biotomy::tests {

/// Stands in for systemd: a datagram socket at a path, which programs find in the environment as
/// long as the object lives, and which keeps all that they say.
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
    reader_ = std::jthread([this](const std::stop_token& stop) { read(stop); });
  }
  ~NotifySocket() {
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
    reader_.request_stop();
    reader_.join();
    close(socket_);
  }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// Waits until messages with `part` in them were said more than `times` times; false when time
  /// is up.
  bool await(const std::string& part, std::chrono::milliseconds time, std::size_t times = 0) {
    std::unique_lock lock(mutex_);
    return said_.wait_for(lock, time, [&] { return count_of(part) > times; });
  }

  /// How many messages had `part` in them so far.
  std::size_t count(const std::string& part) const {
    const std::scoped_lock lock(mutex_);
    return count_of(part);
  }

  std::vector<std::string> messages() const {
    const std::scoped_lock lock(mutex_);
    return messages_;
  }

 private:
  std::size_t count_of(const std::string& part) const {
    return static_cast<std::size_t>(std::count_if(
        messages_.begin(), messages_.end(),
        [&](const std::string& message) { return message.find(part) != std::string::npos; }));
  }

  void read(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      pollfd wait{socket_, POLLIN, 0};
      if (poll(&wait, 1, 20) <= 0) continue;
      std::array<char, 8192> text{};
      const ssize_t count = recv(socket_, text.data(), text.size(), 0);
      if (count < 0) continue;
      const std::scoped_lock lock(mutex_);
      messages_.emplace_back(text.data(), static_cast<std::size_t>(count));
      said_.notify_all();
    }
  }

  int socket_;
  mutable std::mutex mutex_;
  std::condition_variable said_;
  std::vector<std::string> messages_;
  std::jthread reader_;
};

}  // namespace biotomy::tests
