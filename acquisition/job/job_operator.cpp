// What a job does with the operator's commands.
#include <cmath>
#include <string>
#include <utility>

#include "acquisition/job/job.hpp"
#include "acquisition/job/step_alarm.hpp"
#include "acquisition/log.hpp"
#include "acquisition/rig/stage_checks.hpp"

namespace biotomy::acquisition {
namespace {

OperatorReply accepted(std::string sentence) {
  return {true, std::move(sentence)};
}

OperatorReply refused(std::string sentence) {
  return {false, std::move(sentence)};
}

/// Whether the command begins something, for which the controller must be seen. What ends something
/// is never kept waiting.
bool needs_sight(OperatorCommand command) {
  return command == OperatorCommand::start || command == OperatorCommand::resume ||
         command == OperatorCommand::acknowledge || command == OperatorCommand::calibrate_flat ||
         command == OperatorCommand::calibrate_dark ||
         command == OperatorCommand::calibrate_white || command == OperatorCommand::calibrate_focus;
}

}  // namespace

void Job::hear_operator(TimePoint now) {
  for (const std::string& remark : parts_.desk.take_remarks()) note("operator", remark);
  for (OperatorDesk::Request& request : parts_.desk.take()) waiting_.push_back(std::move(request));
  std::vector<OperatorDesk::Request> unheard;
  for (OperatorDesk::Request& request : std::exchange(waiting_, {})) {
    // An exchange that a bad line lost is no reason to turn a person away: the next one is near.
    if (needs_sight(request.command) && !fresh_ && !supervision_.standing_cause()) {
      unheard.push_back(std::move(request));
    } else {
      hear(request, now);
    }
  }
  waiting_ = std::move(unheard);
}

void Job::hear(OperatorDesk::Request& request, TimePoint now) {
  unattended_restart_.give_up();
  OperatorReply reply;
  try {
    reply = obey(request.command, now);
  } catch (const std::exception& error) {
    fault({alarm_kind_of(error, state_), error.what()}, now);
    reply = refused(error.what());
  }
  const std::string text = std::string(to_string(request.command)) +
                           (request.who.empty() ? "" : " by " + request.who) +
                           (request.reason.empty() ? "" : " (" + request.reason + ")") +
                           (reply.accepted ? ": " : " was refused: ") + reply.sentence;
  log_info("operator", text);
  note("operator", text);
  if (state_ == JobState::resetting && reply.accepted && !reset_answer_) {
    reset_answer_ = std::move(request.reply);
  } else {
    answers_.push_back({std::move(request.reply), std::move(reply)});
  }
}

void Job::answer_operator() {
  for (Answer& answer : answers_) answer.promise.set_value(std::move(answer.reply));
  answers_.clear();
}

OperatorReply Job::obey(OperatorCommand command, TimePoint now) {
  if (auto why = why_not(command)) return refused(std::move(*why));
  switch (command) {
    case OperatorCommand::start:
      return begin(JobEvent::start, now);
    case OperatorCommand::resume:
      return begin(JobEvent::resume, now);
    case OperatorCommand::pause:
      if (state_ == JobState::resetting) return do_not_start();
      pause_requested_ = state_ != JobState::pausing;
      return accepted("the step at hand is finished, then the rig is parked");
    case OperatorCommand::abort:
      if (calibration_) {
        give_up_calibration("abort", now);
        return accepted("the calibration is given up");
      }
      if (state_ == JobState::resetting) return do_not_start();
      go(JobEvent::abort, now);
      return accepted("the rig is stopped and parked");
    case OperatorCommand::acknowledge:
      return acknowledge(now);
    case OperatorCommand::calibrate_flat:
      return calibrate(CalibrationKind::flat, now);
    case OperatorCommand::calibrate_dark:
      return calibrate(CalibrationKind::dark, now);
    case OperatorCommand::calibrate_white:
      return calibrate(CalibrationKind::white, now);
    case OperatorCommand::calibrate_focus:
      return calibrate_focus(now);
    case OperatorCommand::shut_down:
      shutting_down_ = true;
      if (calibration_) {
        give_up_calibration("the daemon is being stopped", now);
      }
      pause_requested_ = !is_at_rest(state_);
      return accepted("the rig is brought to rest");
  }
  return refused("unknown command");
}

std::optional<std::string> Job::why_not(OperatorCommand command) const {
  if (command == OperatorCommand::shut_down) return std::nullopt;
  if (shutting_down_) return "the daemon is being stopped";
  const std::string state = to_string(state_);
  switch (command) {
    case OperatorCommand::start:
      return why_not_begin(JobEvent::start);
    case OperatorCommand::resume:
      return why_not_begin(JobEvent::resume);
    case OperatorCommand::pause:
      if (state_ == JobState::resetting && start_after_reset_) return std::nullopt;
      if (is_at_rest(state_) || state_ == JobState::resetting || state_ == JobState::aborting ||
          state_ == JobState::finishing) {
        return "the job is " + state + ": there is nothing to pause";
      }
      return std::nullopt;
    case OperatorCommand::abort:
      if (calibration_ || next_state(state_, JobEvent::abort) ||
          (state_ == JobState::resetting && start_after_reset_)) {
        return std::nullopt;
      }
      return "the job is " + state + ": there is nothing to abort";
    case OperatorCommand::acknowledge:
      return why_not_acknowledge();
    case OperatorCommand::calibrate_flat:
    case OperatorCommand::calibrate_dark:
      return why_no_field();
    default:
      return why_no_calibration();
  }
}

std::optional<std::string> Job::why_not_begin(JobEvent event) const {
  if (calibration_) return "a calibration is under way: wait for its end, or abort it";
  if (next_state(state_, event)) {
    // What only an acknowledgement cures becomes an alarm, which can be acknowledged.
    const auto cause = supervision_.standing_cause();
    return cause ? "not while something is wrong with the rig: " + cause->sentence
                 : turning_wheel();
  }
  if (state_ != JobState::faulted) {
    return std::string("the job is ") + to_string(state_) + ": " + to_string(event) +
           " does nothing now";
  }
  const bool controller_latched = fresh_ && (fresh_->state == bridge::ControllerState::faulted ||
                                             fresh_->interlocks.watchdog_tripped);
  if (controller_latched) {
    const auto cause = supervision_.cause();
    return "the controller is stopped by an alarm (" +
           (cause ? cause->sentence : std::string("of an unknown cause")) +
           "): acknowledge it first";
  }
  if (!start_up_latch_ || event != JobEvent::start) {
    return "the rig is stopped by an alarm (" + alarm_->cause + "): acknowledge it first";
  }
  return why_not_acknowledge();
}

OperatorReply Job::begin(JobEvent event, TimePoint now) {
  if (next_state(state_, event)) {
    go(event, now);
    return accepted("the checks have begun");
  }
  // The operator who starts a rig whose daemon has just started has looked at it.
  OperatorReply reply = acknowledge(now);
  start_after_reset_ = reply.accepted;
  return reply;
}

std::optional<std::string> Job::why_not_acknowledge() const {
  if (state_ != JobState::faulted) {
    return std::string("the job is ") + to_string(state_) + ": there is no alarm to acknowledge";
  }
  if (const auto cause = supervision_.standing_cause()) {
    return "the cause is still there: " + cause->sentence;
  }
  if (temperature_alarm_) {
    if (const auto cause = supervision_.temperature_cause()) {
      return "the cause is still there: " + cause->sentence;
    }
  }
  if (!at_rest()) return "the rig is still being parked: wait a moment";
  if (!fresh_) return "the controller did not answer just now: try again";
  return turning_wheel();
}

std::optional<std::string> Job::turning_wheel() const {
  if (!fresh_ || !wheel_turns(*fresh_, settings_.limits)) return std::nullopt;
  return "the wheel still turns, at " + std::to_string(std::lround(std::abs(fresh_->spindle_rpm))) +
         " rpm: wait until it stands, or switch its drive off";
}

/// While the latch is reset for a job that was to start.
OperatorReply Job::do_not_start() {
  start_after_reset_ = went_on_by_itself_ = false;
  return accepted("the alarm is acknowledged, and the job does not start");
}

OperatorReply Job::acknowledge(TimePoint now) {
  if (auto why = why_not_acknowledge()) return refused(std::move(*why));
  go(JobEvent::acknowledge, now);
  return accepted("the alarm is acknowledged");
}

std::vector<OperatorCommand> Job::accepted_commands() const {
  std::vector<OperatorCommand> commands;
  for (const OperatorCommand command : personal_commands()) {
    if (!why_not(command)) commands.push_back(command);
  }
  return commands;
}

void Job::go_on_by_itself(TimePoint now) {
  const UnattendedRestart::Decision decision =
      unattended_restart_.poll(fresh_, supervision_.standing_cause(), !fault_stop_.is_over(), now);
  if (!decision.why_not.empty()) {
    alarm_->cause = decision.why_not;
    log_warning("job", decision.why_not);
    note("alarm", decision.why_not);
  }
  if (!decision.goes_on) return;
  try {
    const OperatorReply reply = acknowledge(now);
    start_after_reset_ = went_on_by_itself_ = reply.accepted;
    log_info("job", reply.accepted ? "goes on by itself after a restart" : reply.sentence);
  } catch (const std::exception& error) {
    fault({alarm_kind_of(error, state_), error.what()}, now);
  }
}

}  // namespace biotomy::acquisition
