#include "tests/faults/rig_operator.hpp"

#include <chrono>
#include <stdexcept>
#include <thread>

#include <nlohmann/json.hpp>

namespace biotomy::tests {

namespace {

constexpr std::chrono::seconds kPatience(120);
constexpr std::chrono::milliseconds kPollInterval(20);

bool stands_still(const std::string& state) {
  return state == "faulted" || state == "paused" || state == "idle";
}

}  // namespace

void RigOperator::go_on() {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    const nlohmann::json status = status_();
    const std::string state = status.at("state");
    if (!stands_still(state) && state != "resetting") return;
    const nlohmann::json& alarm = status.at("alarm");
    const std::string cause = alarm.is_object() ? alarm.at("cause").get<std::string>() : "";
    if (std::chrono::steady_clock::now() > deadline) {
      throw std::runtime_error("the rig does not go on: " + status.dump(1));
    }
    act(state, cause);
  }
}

void RigOperator::act(const std::string& state, const std::string& alarm) {
  const bool just_started = alarm.find("the daemon has just started") != std::string::npos;
  Outcome
      outcome;  // of nothing, where the daemon has not looked at the rig yet: another look helps
  if (state == "paused") {
    outcome = command_("resume");
  } else if (state == "idle" || just_started) {
    outcome = command_("start");
    const bool latched = outcome.errors.find("acknowledge it first") != std::string::npos;
    if (latched) outcome = command_("acknowledge");
  } else if (state == "faulted" && !alarm.empty()) {
    outcome = command_("acknowledge");
    if (outcome.exit_code == 0) alarms_.push_back(alarm);
  }
  if (outcome.exit_code != 0) std::this_thread::sleep_for(kPollInterval);
}

}  // namespace biotomy::tests
