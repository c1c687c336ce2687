// The steps of a job around the layers: preflight, recovering, homing, finishing, resetting.
#include <algorithm>
#include <string>
#include <utility>
#include <variant>

#include "acquisition/job/job.hpp"
#include "acquisition/log.hpp"
#include "acquisition/records/journal_rows.hpp"
#include "acquisition/rig/stage_checks.hpp"
#include "acquisition/rig/stage_identity.hpp"

namespace biotomy::acquisition {

void Job::begin_preflight(TimePoint now) {
  job_begun_ = true;
  alarm_.reset();
  supervision_.forget_positions();
  lamp_and_tower(false);
  continuation_.reset();
  time_left_.end();
  cycle_.reset();
  identity_.reset();
  // The records of an earlier run are closed, after all they still write, before they are opened
  // anew. By the workers, as that waits for the disk.
  feed_.reset();
  keeper_.reset();
  events_.reset();
  parts_.worker.post(
      [records = std::exchange(findings_.records, nullptr)]() mutable { records.reset(); });
  findings_ = PreflightFindings();
  inspection_ = {};
  clock_wait_.begin();
  begin_inspection(now);
}

/// Once the controller has said what it is and fits, and the clock can be right.
void Job::begin_inspection(TimePoint now) {
  if (!identity_) {
    identity_ = ask_identity(parts_.stage);
    if (!identity_) return;
    check_stage(settings_, *identity_);
  }
  if (!clock_wait_.poll(surroundings_.wall_clock(), now)) {
    step_begin_ = now;  // the wait has its own limit, and leaves the rest of the step its own
    return;
  }
  inspection_ = run_on(parts_.worker,
                       [settings = settings_, camera = &parts_.camera, surroundings = surroundings_,
                        wrong_record = clock_wait_.wrong_record()] {
                         return inspect(settings, *camera, surroundings, wrong_record);
                       });
}

std::optional<JobEvent> Job::poll_preflight(TimePoint now) {
  if (!inspection_.valid()) begin_inspection(now);
  if (!inspection_.valid() || !is_ready(inspection_)) return std::nullopt;
  try {
    findings_ = inspection_.get();
  } catch (const ClockBehind& behind) {
    clock_wait_.is_behind(behind.record_at());
    return std::nullopt;
  }
  commands_.raise_to(std::max(
      {findings_.journal.last_sequence, fresh_->sequence_started, fresh_->sequence_finished}));
  keeper_.emplace(parts_.worker, findings_.records);
  events_.emplace(parts_.event_worker, findings_.records->sample().journal_path());
  write_early_notes();
  feed_.emplace(parts_.volume_worker, surroundings_.open_volume(findings_.records->sample(),
                                                                settings_.store.volume_layout));
  committed_ = findings_.journal.last_committed;
  feed_->offer(committed_);
  note("operator",
       std::string(std::exchange(went_on_by_itself_, false) ? "goes on by itself after a restart; "
                                                            : "begun; ") +
           std::to_string(committed_) + " layers are committed");
  return JobEvent::step_done;
}

std::optional<JobEvent> Job::poll_recovering() {
  if (fresh_->state != bridge::ControllerState::idle) return std::nullopt;
  if (!wheel_stands(*fresh_, settings_.limits)) return std::nullopt;
  const auto answer = where_to_go_on(settings_.plan, findings_.journal, *fresh_, settings_.limits);
  if (const auto* disagreement = std::get_if<Disagreement>(&answer)) {
    throw StepFailure(disagreement->sentence, AlarmKind::disagreement);
  }
  continuation_ = std::get<Continuation>(answer);
  if (continuation_->finished_grind) {
    keeper_->post(
        [sequence = *continuation_->finished_grind, status = *fresh_](SampleRecords& records) {
          records.end_grind(sequence, bridge::CommandResult::done, status);
        });
  }
  if (continuation_->layer > settings_.plan.layers) return JobEvent::nothing_left;

  note("recovery", std::string(kGoesOnWithLayer) + std::to_string(continuation_->layer) +
                       (continuation_->ground ? ", which is ground already" : ""));
  cycle_ = std::make_unique<LayerCycle>(
      settings_,
      CycleParts{commands_, parts_.lines, parts_.camera, parts_.worker, *keeper_, *feed_},
      CycleStart{findings_.journal, identity_->column, findings_.camera, findings_.disk_left_layers,
                 findings_.recalled});
  return JobEvent::agreed;
}

std::optional<JobEvent> Job::poll_conditioning(TimePoint now) {
  if (!conditioning_.poll(*fresh_, now)) return std::nullopt;
  return continuation_->ground ? JobEvent::photograph_next : JobEvent::grind_next;
}

std::optional<JobEvent> Job::poll_finishing(TimePoint now) {
  if (!parking_.poll(*fresh_, now)) return std::nullopt;
  const VolumeFeed::Progress volume = feed_->progress();
  if (volume.layers_present != volume_seen_) {
    volume_seen_ = volume.layers_present;
    volume_moved_ = now;
  }
  if (volume.finished) return JobEvent::step_done;
  // The layers are safe; a volume that fails does not make the job fail.
  if (!volume.failure.empty() || now - volume_moved_ > settings_.limits.volume_limit) {
    log_error("volume",
              "it is not complete; the layers are safe: once the daemon is stopped, biotomy "
              "rebuild " +
                  settings_.plan.sample.string() + " makes it anew");
    note("alarm",
         "the volume is not complete: " +
             (volume.failure.empty() ? std::string("it does not grow any more") : volume.failure));
    return JobEvent::step_done;
  }
  return std::nullopt;
}

void Job::begin_resetting(TimePoint now) {
  fault_stop_.acknowledge();
  const bool latched = fresh_ && (fresh_->state == bridge::ControllerState::faulted ||
                                  fresh_->interlocks.watchdog_tripped);
  if (!latched) return;
  commands_.begin({.action = bridge::StageAction::reset_fault}, now);
  step_command_begun_ = true;
}

std::optional<JobEvent> Job::poll_resetting(TimePoint now) {
  if (const auto cause = supervision_.standing_cause())
    throw StepFailure(cause->sentence, cause->kind);
  if (step_command_begun_ && !commands_.poll_done(*fresh_, now)) return std::nullopt;
  if (fresh_->state == bridge::ControllerState::faulted || fresh_->interlocks.watchdog_tripped) {
    return std::nullopt;
  }
  alarm_.reset();
  start_up_latch_ = false;
  lamp_and_tower(false);
  return job_begun_ ? JobEvent::reset_with_job : JobEvent::reset_without_job;
}

}  // namespace biotomy::acquisition
