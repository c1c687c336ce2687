#include "firmware_bridge/wire/endpoint.hpp"

#include <charconv>

namespace biotomy::bridge {

namespace {

[[noreturn]] void refuse(std::string_view text, const std::string& what) {
  throw ConfigurationError("endpoint \"" + std::string(text) + "\": " + what +
                           "; expected tcp://host:port, unix://path or rtu:///dev/name");
}

bool take_prefix(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

Endpoint parse_tcp(std::string_view whole, std::string_view rest) {
  const std::size_t colon = rest.rfind(':');
  if (colon == std::string_view::npos) refuse(whole, "it has no port");
  std::string_view host = rest.substr(0, colon);
  const std::string_view port = rest.substr(colon + 1);
  if (host.starts_with('[') && host.ends_with(']')) {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string_view::npos) {
    refuse(whole, "an IPv6 address needs brackets");
  }
  if (host.empty()) refuse(whole, "it has no host");

  Endpoint endpoint{
      .scheme = Endpoint::Scheme::tcp, .host = std::string(host), .port = 0, .path = {}};
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), endpoint.port);
  if (error != std::errc() || end != port.data() + port.size()) {
    refuse(whole, "the port is no number from 0 to 65535");
  }
  return endpoint;
}

}  // namespace

Endpoint parse_endpoint(std::string_view text) {
  std::string_view rest = text;
  if (take_prefix(rest, "tcp://")) return parse_tcp(text, rest);

  Endpoint endpoint;
  if (take_prefix(rest, "unix://")) {
    endpoint.scheme = Endpoint::Scheme::unix_socket;
  } else if (take_prefix(rest, "rtu://")) {
    endpoint.scheme = Endpoint::Scheme::rtu;
  } else {
    refuse(text, "unknown kind");
  }
  if (rest.empty()) refuse(text, "it has no path");
  endpoint.path = rest;
  return endpoint;
}

std::string to_string(const Endpoint& endpoint) {
  switch (endpoint.scheme) {
    case Endpoint::Scheme::tcp: {
      const bool is_ipv6 = endpoint.host.find(':') != std::string::npos;
      return "tcp://" + (is_ipv6 ? "[" + endpoint.host + "]" : endpoint.host) + ":" +
             std::to_string(endpoint.port);
    }
    case Endpoint::Scheme::unix_socket:
      return "unix://" + endpoint.path;
    case Endpoint::Scheme::rtu:
      return "rtu://" + endpoint.path;
  }
  return {};
}

}  // namespace biotomy::bridge
