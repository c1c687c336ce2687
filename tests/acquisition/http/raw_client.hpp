#pragma once

#include <stdexcept>
#include <string>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::tests {

/// A client that sends what no library would, and reads when it likes.
class RawClient {
 public:
  /// `receive_buffer` in bytes, 0 as the system chooses.
  explicit RawClient(int port, int receive_buffer = 0)
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    if (receive_buffer > 0) {
      ::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    }
    const timeval patience{.tv_sec = 30, .tv_usec = 0};
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("nobody listens");
    }
  }

  void send(const std::string& text) const {
    ::send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL);
  }

  void get(const std::string& path, const std::string& headers = "") const {
    send("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n" + headers + "\r\n");
  }

  /// Reads on until the text has all of `end`; less when the server ends the connection before.
  std::string read_until(const std::string& end) {
    while (received_.find(end) == std::string::npos && read_some()) {
    }
    const std::size_t found = received_.find(end);
    const std::size_t length = found == std::string::npos ? received_.size() : found + end.size();
    std::string text = received_.substr(0, length);
    received_.erase(0, length);
    return text;
  }

  /// Reads until the server ends the connection. Throws when it does not within half a minute.
  std::string read_all() {
    while (read_some()) {
    }
    return std::exchange(received_, {});
  }

  void leave() { socket_.reset(); }

 private:
  bool read_some() {
    char buffer[65536];
    const ssize_t bytes = ::recv(socket_.get(), buffer, sizeof buffer, 0);
    if (bytes < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      throw std::runtime_error("the server says nothing more and does not end the connection");
    }
    if (bytes <= 0) return false;
    received_.append(buffer, static_cast<std::size_t>(bytes));
    return true;
  }

  bridge::UniqueFd socket_;
  std::string received_;
};

}  // namespace biotomy::tests
