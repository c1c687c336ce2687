#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "acquisition/http/http_application.hpp"
#include "acquisition/http/http_settings.hpp"

namespace biotomy::acquisition {

/// The address cannot be listened on.
class ListenError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Why a server could not listen there now; nothing when it could.
std::optional<std::string> listen_complaint(const std::string& host, int port);

/// Speaks HTTP for an application until destroyed. One thread holds all connections, however many
/// and however slow; each lane's threads answer. What is more than the limits is turned away at
/// once: full lanes with 503, too many pictures with 429.
class HttpServer {
 public:
  /// Port 0 is any free port. Throws ListenError, as when another program has the port. The
  /// application outlives the server.
  HttpServer(const HttpApplication& application, const std::string& host, int port,
             HttpSettings settings = {});
  /// Ends all connections; waits for the answers that are being made, which are asked to give up.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;

 private:
  class Listening;
  std::unique_ptr<Listening> listening_;
};

}  // namespace biotomy::acquisition
