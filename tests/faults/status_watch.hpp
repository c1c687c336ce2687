#pragma once

#include <functional>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

namespace httplib {
class Client;
}

namespace biotomy::tests {

/// Looks at a daemon's status over one connection, fast enough to see each of its ticks.
class StatusWatch {
 public:
  explicit StatusWatch(const std::string& url);
  ~StatusWatch();

  /// Throws std::runtime_error when the daemon does not answer.
  nlohmann::json look();

  /// Looks until a status `holds`, and returns it. Throws std::runtime_error with the last status
  /// when the job is done without it, or that takes more than a minute.
  nlohmann::json await(const std::function<bool(const nlohmann::json&)>& holds);

  nlohmann::json await_state(const std::string& state);
  nlohmann::json await_committed(std::int64_t layers);

  /// Until the job stands still by itself: faulted, paused or held.
  nlohmann::json await_stop();

 private:
  std::unique_ptr<httplib::Client> client_;
};

/// The sentence with which the operator is told why the job stands still; empty when it does not.
std::string told(const nlohmann::json& status);

}  // namespace biotomy::tests
