#pragma once

#include <cstdint>
#include <optional>

#include "acquisition/rig/step_failure.hpp"
#include "acquisition/settings/safety_limits.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Hands commands to the stage so that each is executed exactly once, and follows the one that is
/// under way. A hand-over that was not answered is never repeated blindly: the controller's echo is
/// read back, for `SafetyLimits::read_back`; only a command that it did not start is handed over
/// again, and under the same number, so that a first message that was merely late changes nothing.
class StageCommands {
 public:
  StageCommands(bridge::Stage& stage, const SafetyLimits& limits);

  /// Numbers up to `used` are never handed out: they are in the journal or in the controller.
  void raise_to(std::uint32_t used);

  /// The number that the next command will carry; it can be written down before the command is
  /// issued.
  std::uint32_t next_sequence() const { return last_sequence_ + 1; }

  /// Hands `command` over under `next_sequence()`. Throws StepFailure when the stage refuses it.
  void begin(const bridge::StageCommand& command, TimePoint now);

  /// How the command under way ended; nothing while it runs. `status` was read after `begin`.
  /// Throws StepFailure when the controller does not take the command.
  std::optional<bridge::CommandResult> poll(const bridge::StageStatus& status, TimePoint now);

  /// The same, but only `done` is an answer; throws StepFailure for refused and aborted.
  bool poll_done(const bridge::StageStatus& status, TimePoint now);

  /// Spindle off, axes halted, whatever is under way. False when the stage did not listen.
  bool stop_now(TimePoint now);

 private:
  void hand_over(TimePoint now);

  bridge::Stage& stage_;
  SafetyLimits limits_;
  std::uint32_t last_sequence_ = 0;
  bridge::StageCommand command_;
  TimePoint handed_over_at_{};
  std::optional<TimePoint> read_back_since_;
  bool answered_ = false;
  bool started_ = false;
  int issues_ = 0;
};

}  // namespace biotomy::acquisition
