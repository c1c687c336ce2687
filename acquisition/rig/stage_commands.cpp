#include "acquisition/rig/stage_commands.hpp"

#include <algorithm>
#include <string>

#include "acquisition/log.hpp"
#include "firmware_bridge/device_error.hpp"

namespace biotomy::acquisition {
namespace {

constexpr const char* kComponent = "stage";

std::string named(const bridge::StageCommand& command, std::uint32_t sequence) {
  return std::string(bridge::to_string(command.action)) + " (command " + std::to_string(sequence) +
         ")";
}

}  // namespace

StageCommands::StageCommands(bridge::Stage& stage, const SafetyLimits& limits)
    : stage_(stage), limits_(limits) {}

void StageCommands::raise_to(std::uint32_t used) {
  last_sequence_ = std::max(last_sequence_, used);
}

void StageCommands::begin(const bridge::StageCommand& command, TimePoint now) {
  command_ = command;
  ++last_sequence_;
  issues_ = 0;
  started_ = false;
  hand_over(now);
}

void StageCommands::hand_over(TimePoint now) {
  ++issues_;
  handed_over_at_ = now;
  read_back_since_.reset();
  answered_ = false;
  try {
    stage_.issue(last_sequence_, command_);
    answered_ = true;
  } catch (const bridge::DeviceError& error) {
    const bool may_have_arrived = error.kind() == bridge::DeviceError::Kind::timeout ||
                                  error.kind() == bridge::DeviceError::Kind::disconnected;
    if (!may_have_arrived) throw StepFailure(error.what(), AlarmKind::link);
    log_warning(kComponent, named(command_, last_sequence_) +
                                " was not answered, its number is read back: " + error.what());
  }
}

std::optional<bridge::CommandResult> StageCommands::poll(const bridge::StageStatus& status,
                                                         TimePoint now) {
  if (status.sequence_finished == last_sequence_) return status.last_result;
  if (status.sequence_started == last_sequence_) {
    started_ = true;
    return std::nullopt;
  }
  if (started_) {
    throw StepFailure("the controller forgot " + named(command_, last_sequence_) +
                          ": was it restarted? Look at the rig before going on",
                      AlarmKind::controller);
  }
  if (answered_) {
    if (now - handed_over_at_ > limits_.command_start) {
      throw StepFailure("the controller took " + named(command_, last_sequence_) +
                            " but does not start it: look at the controller's program",
                        AlarmKind::controller);
    }
    return std::nullopt;
  }
  if (!read_back_since_) read_back_since_ = now;
  if (now - *read_back_since_ < limits_.read_back) return std::nullopt;
  if (issues_ >= limits_.command_issues) {
    throw StepFailure("the controller did not receive " + named(command_, last_sequence_) + " in " +
                          std::to_string(issues_) + " attempts: check the link",
                      AlarmKind::link);
  }
  hand_over(now);
  return std::nullopt;
}

bool StageCommands::poll_done(const bridge::StageStatus& status, TimePoint now) {
  const std::optional<bridge::CommandResult> result = poll(status, now);
  if (!result) return false;
  if (*result == bridge::CommandResult::done) return true;
  throw StepFailure("the controller answered " + named(command_, last_sequence_) + " with " +
                        bridge::to_string(*result),
                    AlarmKind::controller);
}

bool StageCommands::stop_now(TimePoint now) {
  ++last_sequence_;
  issues_ = 1;
  started_ = false;
  answered_ = false;
  read_back_since_.reset();
  handed_over_at_ = now;
  command_ = {.action = bridge::StageAction::stop};
  try {
    stage_.issue(last_sequence_, command_);
    answered_ = true;
  } catch (const bridge::DeviceError& error) {
    log_error(kComponent, std::string("stop could not be handed over: ") + error.what());
  }
  return answered_;
}

}  // namespace biotomy::acquisition
