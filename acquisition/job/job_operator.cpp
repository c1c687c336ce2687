// What a job does with the operator's commands.
#include <utility>

#include "acquisition/job/job.hpp"
#include "acquisition/log.hpp"

namespace biotomy::acquisition {
namespace {

OperatorReply accepted(std::string sentence) {
  return {true, std::move(sentence)};
}

OperatorReply refused(std::string sentence) {
  return {false, std::move(sentence)};
}

}  // namespace

void Job::hear_operator(TimePoint now) {
  for (OperatorDesk::Request& request : parts_.desk.take()) {
    OperatorReply reply;
    try {
      reply = obey(request.command, now);
    } catch (const std::exception& error) {
      fault(error.what(), now);
      reply = refused(error.what());
    }
    const std::string text = std::string(to_string(request.command)) +
                             (request.reason.empty() ? "" : " (" + request.reason + ")") +
                             (reply.accepted ? "" : " was refused: " + reply.sentence);
    log_info("operator", text);
    note("operator", text);
    if (state_ == JobState::resetting && reply.accepted && !reset_answer_) {
      reset_answer_ = std::move(request.reply);
    } else {
      answers_.push_back({std::move(request.reply), std::move(reply)});
    }
  }
}

void Job::answer_operator() {
  for (Answer& answer : answers_) answer.promise.set_value(std::move(answer.reply));
  answers_.clear();
}

OperatorReply Job::obey(OperatorCommand command, TimePoint now) {
  const std::string state = to_string(state_);
  if (shutting_down_ && command != OperatorCommand::shut_down) {
    return refused("the daemon is being stopped");
  }
  switch (command) {
    case OperatorCommand::start:
      return begin(JobEvent::start, now);
    case OperatorCommand::resume:
      return begin(JobEvent::resume, now);
    case OperatorCommand::pause:
      if (is_at_rest(state_) || state_ == JobState::resetting || state_ == JobState::aborting ||
          state_ == JobState::finishing) {
        return refused("the job is " + state + ": there is nothing to pause");
      }
      pause_requested_ = state_ != JobState::pausing;
      return accepted("the step at hand is finished, then the rig is parked");
    case OperatorCommand::abort:
      if (!next_state(state_, JobEvent::abort)) {
        return refused("the job is " + state + ": there is nothing to abort");
      }
      go(JobEvent::abort, now);
      return accepted("the rig is stopped and parked");
    case OperatorCommand::acknowledge:
      return acknowledge(now);
    case OperatorCommand::shut_down:
      shutting_down_ = true;
      pause_requested_ = !is_at_rest(state_);
      return accepted("the rig is brought to rest");
  }
  return refused("unknown command");
}

OperatorReply Job::begin(JobEvent event, TimePoint now) {
  if (next_state(state_, event)) {
    go(event, now);
    return accepted("the checks have begun");
  }
  if (state_ != JobState::faulted) {
    return refused(std::string("the job is ") + to_string(state_) + ": " + to_string(event) +
                   " does nothing now");
  }
  const bool controller_latched = fresh_ && (fresh_->state == bridge::ControllerState::faulted ||
                                             fresh_->interlocks.watchdog_tripped);
  if (controller_latched) {
    return refused("the controller is stopped by an alarm (" +
                   supervision_.cause().value_or("of an unknown cause") +
                   "): acknowledge it first");
  }
  if (!start_up_latch_ || event != JobEvent::start) {
    return refused("the rig is stopped by an alarm (" + alarm_->cause + "): acknowledge it first");
  }
  // The operator who starts a rig whose daemon has just started has looked at it.
  OperatorReply reply = acknowledge(now);
  start_after_reset_ = reply.accepted;
  return reply;
}

OperatorReply Job::acknowledge(TimePoint now) {
  if (state_ != JobState::faulted) {
    return refused(std::string("the job is ") + to_string(state_) +
                   ": there is no alarm to acknowledge");
  }
  if (const auto cause = supervision_.standing_cause()) {
    return refused("the cause is still there: " + *cause);
  }
  if (!at_rest()) return refused("the rig is still being parked: wait a moment");
  if (!fresh_) return refused("the controller did not answer just now: try again");
  go(JobEvent::acknowledge, now);
  return accepted("the alarm is acknowledged");
}

}  // namespace biotomy::acquisition
