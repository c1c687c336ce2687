#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "acquisition/service/api.hpp"

namespace biotomy::acquisition {

/// The address cannot be listened on.
class ListenError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Why a server could not listen there now; nothing when it could.
std::optional<std::string> listen_complaint(const std::string& host, int port);

/// Speaks HTTP for an Api, with threads of its own, until destroyed. Bodies over 64 KiB, slow
/// clients and long headers are turned away.
class HttpServer {
 public:
  /// Port 0 is any free port. Throws ListenError, as when another program has the port. The API
  /// outlives the server.
  HttpServer(const Api& api, const std::string& host, int port);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace biotomy::acquisition
