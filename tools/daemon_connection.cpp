#include "tools/daemon_connection.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "reconstruct/errors.hpp"
#include "reconstruct/utf8.hpp"

namespace biotomy::tools {
namespace {

using nlohmann::json;
using reconstruct::InvalidRequest;

constexpr int kConnectSeconds = 3;
constexpr int kAnswerSeconds = 15;
constexpr const char* kTokenVariable = "BIOTOMY_TOKEN";

const std::string& checked(const std::string& url) {
  if (!url.starts_with("http://")) {
    throw InvalidRequest("--url: \"" + url + "\" is not possible; expected http://host:port");
  }
  return url;
}

/// The last word of the file's first line: it may be "name token". Empty when no token was given.
std::string token_of(const DaemonOptions& options) {
  if (options.token_file.empty()) {
    const char* variable = std::getenv(kTokenVariable);
    return variable == nullptr ? "" : variable;
  }
  std::ifstream file(options.token_file);
  std::string token;
  for (std::string line; token.empty() && std::getline(file, line);) {
    std::istringstream words(line);
    for (std::string word; words >> word && word.front() != '#';) token = word;
  }
  if (token.empty()) {
    throw std::runtime_error("--token-file: no token can be read from " + options.token_file);
  }
  return token;
}

}  // namespace

void add_daemon_options(CLI::App& command, DaemonOptions& options) {
  command.add_option("--url", options.url, "Where biotomyd listens")->capture_default_str();
  command.add_option("--token-file", options.token_file,
                     std::string("A file with the token; else ") + kTokenVariable + " holds it");
}

DaemonConnection::DaemonConnection(const DaemonOptions& options)
    : url_(checked(options.url)), token_(token_of(options)), client_(url_) {
  if (!token_.empty()) client_.set_bearer_token_auth(token_.c_str());
  client_.set_connection_timeout(kConnectSeconds);
  client_.set_read_timeout(kAnswerSeconds);
  client_.set_write_timeout(kAnswerSeconds);
}

std::string DaemonConnection::status_text() {
  return answer(client_.Get("/api/v1/status"));
}

json DaemonConnection::status() {
  json document = json::parse(status_text(), nullptr, false);
  if (!document.is_object() || !document.contains("state")) {
    throw std::runtime_error(url_ + " answers, but not as biotomyd does: is the URL right?");
  }
  return document;
}

std::string DaemonConnection::command(const std::string& name, const std::string& reason) {
  if (token_.empty()) {
    throw InvalidRequest(
        std::string("a command needs the rig's token: give --token-file, or set ") +
        kTokenVariable);
  }
  const std::string body =
      reason.empty() ? "{}" : json{{"reason", reconstruct::utf8_text(reason)}}.dump();
  const std::string text =
      answer(client_.Post("/api/v1/control/" + name, body, "application/json"));
  const json document = json::parse(text, nullptr, false);
  return document.is_object() ? document.value("message", "") : "";
}

std::string DaemonConnection::answer(const httplib::Result& result) const {
  if (!result) {
    throw DaemonAway("no biotomyd answers at " + url_ + ": is it running, and is --url right?");
  }
  if (result->status == 200) return result->body;
  const json document = json::parse(result->body, nullptr, false);
  std::string message = "HTTP status " + std::to_string(result->status);
  if (document.is_object() && document.contains("error") && document["error"].is_object()) {
    message = document["error"].value("message", message);
  }
  if (result->status == 401) {
    message =
        "the daemon at " + url_ + " wants a token: give --token-file, or set " + kTokenVariable;
  } else if (result->status == 403) {
    message = "the daemon at " + url_ +
              " does not know the token: give one that stands in its service.token_file";
  } else if (result->status == 429) {
    throw DaemonAway("the daemon at " + url_ + " turns this computer away for a while: " + message);
  } else if (result->status == 503) {
    throw DaemonAway(message);
  }
  throw std::runtime_error(message);
}

}  // namespace biotomy::tools
