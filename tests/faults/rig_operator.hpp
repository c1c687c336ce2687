#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/integration/child_process.hpp"

namespace biotomy::tests {

/// Does what an operator does with a rig that stands still: acknowledges, starts, resumes.
class RigOperator {
 public:
  using Command = std::function<Outcome(const std::string& command)>;  ///< `biotomy rig COMMAND`
  using Status = std::function<nlohmann::json()>;                      ///< /api/v1/status

  RigOperator(Command command, Status status)
      : command_(std::move(command)), status_(std::move(status)) {}

  /// Until the job is at its steps again or done. Throws std::runtime_error when it will not go on.
  void go_on();

  /// The causes of the alarms that were acknowledged.
  const std::vector<std::string>& alarms() const { return alarms_; }

 private:
  void act(const std::string& state, const std::string& alarm);

  Command command_;
  Status status_;
  std::vector<std::string> alarms_;
};

}  // namespace biotomy::tests
