#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <httplib.h>
#include <nlohmann/json.hpp>

namespace biotomy::tools {

/// Where a rig's daemon is, and the right to command it.
struct DaemonOptions {
  std::string url = "http://127.0.0.1:8080";
  std::string token_file;
};

/// The options --url and --token-file.
void add_daemon_options(CLI::App& command, DaemonOptions& options);

/// The daemon does not answer, or has no time to: it may be there again in a moment.
class DaemonAway : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The daemon of a rig, over HTTP. What goes wrong is one line that says what to do.
class DaemonConnection {
 public:
  /// Without a token only a daemon that lets everybody read answers. Throws InvalidRequest for a
  /// URL that cannot be, std::runtime_error when no token can be read.
  explicit DaemonConnection(const DaemonOptions& options);

  /// Throws DaemonAway where asking again may help, std::runtime_error where it does not.
  std::string status_text();
  nlohmann::json status();

  /// Gives a command and returns what the daemon answers. Throws InvalidRequest without a token.
  std::string command(const std::string& name, const std::string& reason);

 private:
  std::string answer(const httplib::Result& result) const;

  std::string url_;
  std::string token_;
  httplib::Client client_;
};

}  // namespace biotomy::tools
