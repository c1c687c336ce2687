#pragma once

#include <optional>
#include <string>

namespace biotomy::acquisition {

/// Where a server listens.
struct ListenAddress {
  std::string host;
  int port = 0;  ///< 0: any that is free
};

/// Of "127.0.0.1:8080", "[::1]:8080", "rig.lab:0"; nothing when it is none.
std::optional<ListenAddress> parse_listen_address(const std::string& text);

/// Whether only this computer reaches the address. A name other than localhost may be any address.
bool is_loopback(const std::string& host);

/// "http://127.0.0.1:8080", "http://[::1]:8080".
std::string http_url(const std::string& host, int port);

}  // namespace biotomy::acquisition
