#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "firmware_bridge/wire/configuration_error.hpp"

namespace biotomy::bridge {

/// Where a device or its stand-in is reached: "tcp://127.0.0.1:1502", "tcp://[::1]:1502",
/// "unix:///run/biotomy/rig.sock" (or a relative path: "unix://rig.sock"), "rtu:///dev/ttyUSB0".
struct Endpoint {
  enum class Scheme { tcp, unix_socket, rtu };

  Scheme scheme = Scheme::tcp;
  std::string host;        ///< tcp
  std::uint16_t port = 0;  ///< tcp; 0 is any free port, for a server
  std::string path;        ///< unix_socket, rtu
};

/// Throws ConfigurationError with the text and the forms that it may have.
Endpoint parse_endpoint(std::string_view text);

std::string to_string(const Endpoint& endpoint);

}  // namespace biotomy::bridge
