#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include <netdb.h>
#include <sys/socket.h>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::bridge {

/// The addresses behind a host and a port. A name is looked up once, here: who connects later never
/// waits for a name server.
class TcpAddresses {
 public:
  /// As getaddrinfo(3).
  using Lookup = int (*)(const char*, const char*, const addrinfo*, addrinfo**);

  /// Throws ConfigurationError if there is no such host, DeviceError (disconnected) if nobody can
  /// tell at present.
  TcpAddresses(const std::string& host, std::uint16_t port, Lookup look_up = ::getaddrinfo);

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
