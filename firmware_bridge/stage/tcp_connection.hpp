#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include <sys/socket.h>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::bridge {

/// The addresses behind a host and a port. A name is looked up once, here: who connects later never
/// waits for a name server.
class TcpAddresses {
 public:
  /// Throws ConfigurationError if there is no such host.
  TcpAddresses(const std::string& host, std::uint16_t port);

  /// A connected, non-blocking socket. Tries the addresses in turn, for `time_out` in all.
  /// Throws std::system_error with what the last one answered (ETIMEDOUT: nothing).
  UniqueFd connect(std::chrono::milliseconds time_out) const;

 private:
  struct Address {
    sockaddr_storage bytes{};
    socklen_t length = 0;
  };
  std::vector<Address> addresses_;
};

}  // namespace biotomy::bridge
