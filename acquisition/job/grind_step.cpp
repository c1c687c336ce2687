#include "acquisition/job/grind_step.hpp"

#include <string>

#include "acquisition/rig/stage_checks.hpp"

namespace biotomy::acquisition {

GrindStep::GrindStep(const JobSettings& settings, StageCommands& commands, RecordKeeper& keeper)
    : settings_(settings), commands_(commands), keeper_(keeper) {}

void GrindStep::begin(std::int64_t layer, const bridge::StageStatus& status) {
  grind_ = {.sequence = commands_.next_sequence(),
            .layer = layer,
            .target = settings_.plan.face_of(layer),
            .ground_before = status.ground_to,
            .count_before = status.grind_count,
            .finished = false};
  issued_ = false;
  intent_ = keeper_.ask([grind = grind_](SampleRecords& records) { records.begin_grind(grind); });
}

bool GrindStep::poll(const bridge::StageStatus& status, TimePoint now) {
  if (!issued_) {
    if (!is_ready(intent_)) return false;
    intent_.get();  // what went wrong with the journal comes out here, and nothing is ground
    commands_.begin({.action = bridge::StageAction::grind_pass,
                     .position = grind_.target,
                     .duration = {},
                     .spindle_rpm = settings_.plan.spindle_rpm},
                    now);
    issued_ = true;
    return false;
  }
  const std::optional<bridge::CommandResult> result = commands_.poll(status, now);
  if (!result) return false;
  keeper_.post([sequence = grind_.sequence, result = *result, status](SampleRecords& records) {
    records.end_grind(sequence, result, status);
  });
  if (*result != bridge::CommandResult::done) {
    throw StepFailure("the controller answered the grind pass of layer " +
                          std::to_string(grind_.layer) + " with " + bridge::to_string(*result),
                      AlarmKind::controller);
  }
  check_done(status);
  return true;
}

void GrindStep::check_done(const bridge::StageStatus& status) const {
  if (status.grind_count != grind_.count_before + 1) {
    throw StepFailure("one grind pass was asked for and the controller counts " +
                          std::to_string(status.grind_count - grind_.count_before) +
                          ": look at the block",
                      AlarmKind::disagreement);
  }
  check_position("feed", status.feed, grind_.target, settings_.limits);
  check_position("ground position", status.ground_to, grind_.target, settings_.limits);
}

const char* GrindStep::waiting_for() const {
  return issued_ ? "waits for the wheel to pass over the block"
                 : "waits for the journal, before the wheel may move";
}

}  // namespace biotomy::acquisition
