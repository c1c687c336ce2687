#include "acquisition/http/listen_address.hpp"

#include <arpa/inet.h>

#include "firmware_bridge/wire/configuration_error.hpp"
#include "firmware_bridge/wire/endpoint.hpp"

namespace biotomy::acquisition {

std::optional<ListenAddress> parse_listen_address(const std::string& text) {
  try {
    const bridge::Endpoint endpoint = bridge::parse_endpoint("tcp://" + text);
    return ListenAddress{endpoint.host, endpoint.port};
  } catch (const bridge::ConfigurationError&) {
    return std::nullopt;
  }
}

bool is_loopback(const std::string& host) {
  if (host == "localhost" || host == "::1") return true;
  in_addr address{};
  return ::inet_pton(AF_INET, host.c_str(), &address) == 1 && (ntohl(address.s_addr) >> 24U) == 127;
}

std::string http_url(const std::string& host, int port) {
  const bool needs_brackets = host.find(':') != std::string::npos;
  return "http://" + (needs_brackets ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

}  // namespace biotomy::acquisition
