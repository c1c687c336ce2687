#include "acquisition/job/layer_cycle.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <utility>

#include "acquisition/job/quality_ladder.hpp"
#include "acquisition/log.hpp"
#include "acquisition/quality/accepted_layer.hpp"
#include "acquisition/rig/capture.hpp"
#include "acquisition/rig/focus_actuators.hpp"

namespace biotomy::acquisition {

using bridge::StageAction;

namespace {

/// The focus's way to its place decides nothing: a face that is sharp may be anywhere.
void note(const Metric& focus_change, Assessment& assessment) {
  assessment.metrics.push_back(focus_change);
  if (focus_change.passed || assessment.verdict != Verdict::accepted) return;
  std::array<char, 100> text{};
  std::snprintf(text.data(), text.size(), "; but the focus left its way by %+.1f µm a layer",
                focus_change.value);
  assessment.reason += text.data();
}

}  // namespace

LayerCycle::LayerCycle(const JobSettings& settings, const CycleParts& parts,
                       const CycleStart& start)
    : settings_(settings),
      parts_(parts),
      focus_memory_(settings.focus, settings.plan.layer_thickness),
      grind_(settings, parts.commands, parts.keeper),
      retraction_(parts.commands, settings.limits),
      focus_(settings,
             make_focus_actuator(settings, start.column, start.camera,
                                 {parts.commands, parts.camera, parts.worker}),
             focus_memory_, parts.camera, parts.worker, parts.keeper),
      layer_(start.journal.last_committed + 1),
      attempt_(start.journal.last_attempt),
      flagged_in_a_row_(start.journal.flagged_in_a_row),
      disk_left_layers_(start.disk_left_layers) {
  expectation_.width = start.camera.width;
  expectation_.height = start.camera.height;
  expectation_.type = settings.plan.bits == 16 ? CV_16UC3 : CV_8UC3;
  expectation_.faces = start.recalled.faces;
  expectation_.sharpness = start.recalled.sharpness;
  expectation_.surfaces = start.recalled.surfaces;
  // What was remembered of the focus is in doubt, and with its peak there is something to compare.
  focus_again_ = flagged_in_a_row_ > 0 || start.journal.focus_in_doubt;
  if (const auto& focus = start.journal.last_focus) {
    focus_memory_.remember({.layer = focus->layer,
                            .position = focus->column,
                            .sharpness = focus->sharpness,
                            .measures = nullptr,
                            .step = {}});
    focus_memory_.keep();
  }
}

void LayerCycle::begin(JobState step, const bridge::StageStatus& status, TimePoint now) {
  step_begin_ = now;
  switch (step) {
    case JobState::grinding:
      grind_.begin(layer_, status);
      break;
    case JobState::retracting:
      retraction_.begin(now);
      break;
    case JobState::clearing:
      parts_.commands.begin({.action = StageAction::clear_face,
                             .position = {},
                             .duration = settings_.plan.clear_duration,
                             .spindle_rpm = 0.0},
                            now);
      break;
    case JobState::lighting:
      parts_.lines.set(bridge::OutputRole::lamp, true);
      break;
    case JobState::focusing:
      // What the layer's last search found gave no frame that is good enough.
      if (focus_memory_.take_back()) focus_again_ = true;
      focus_.begin(layer_,
                   std::exchange(focus_again_, false)
                       ? SearchReason{"the quality ladder asked for it", true}
                       : SearchReason{focus_memory_.why_search(layer_), false},
                   expectation_.sharpness.noise(), now);
      break;
    case JobState::capturing:
      begin_capture(status);
      break;
    case JobState::assessing:
      begin_assessment();
      break;
    case JobState::storing:
      begin_storing();  // first: a lamp that does not go out is no reason to lose the frame
      parts_.lines.set(bridge::OutputRole::lamp, false);
      break;
    default:
      break;
  }
}

std::optional<JobEvent> LayerCycle::poll(JobState step, const bridge::StageStatus& status,
                                         TimePoint now) {
  const auto done_if = [](bool done) {
    return done ? std::optional(JobEvent::step_done) : std::nullopt;
  };
  switch (step) {
    case JobState::grinding:
      return done_if(grind_.poll(status, now));
    case JobState::retracting:
      return done_if(retraction_.poll(status, now));
    case JobState::clearing:
      return done_if(parts_.commands.poll_done(status, now));
    case JobState::settling:
      return done_if(now - step_begin_ >= settings_.plan.settle_duration);
    case JobState::lighting:
      return done_if(now - step_begin_ >= settings_.plan.lamp_warm_up);
    case JobState::focusing:
      return done_if(focus_.poll(status, now));
    case JobState::capturing:
      if (!is_ready(capture_)) return std::nullopt;
      in_hand_ = std::make_shared<JudgedFrame>(capture_.get());
      return JobEvent::step_done;
    case JobState::assessing:
      return is_ready(assessment_) ? judge() : std::nullopt;
    case JobState::storing:
      return is_ready(stored_) ? layer_stored() : std::nullopt;
    default:
      return std::nullopt;
  }
}

void LayerCycle::begin_capture(const bridge::StageStatus& status) {
  ++attempt_;
  ++climbed_;
  capture_ = parts_.keeper.ask(
      [camera = &parts_.camera, layer = layer_, attempt = attempt_, status,
       time_out = settings_.camera.capture_time_out](const SampleRecords& records) {
        JudgedFrame taken;
        taken.layer = layer;
        taken.attempt = attempt;
        taken.column = status.column;
        taken.telemetry = status;
        taken.asked_at = std::chrono::steady_clock::now().time_since_epoch();
        taken.frame = capture(*camera, time_out);
        taken.taken_at = records.now();
        return taken;
      });
}

void LayerCycle::begin_assessment() {
  expectation_.sharpness.found_focus(focus_memory_.peak_layer(), focus_memory_.peak_measures());
  expectation_.layer = layer_;
  expectation_.asked_at = in_hand_->asked_at;
  assessment_ = parts_.keeper.ask([frame = in_hand_, expectation = expectation_,
                                   thresholds = settings_.thresholds](SampleRecords& records) {
    return assess_and_prepare(records, *frame, expectation, thresholds);
  });
}

std::optional<JobEvent> LayerCycle::judge() {
  AssessedFrame assessed = assessment_.get();
  in_hand_->assessment = std::move(assessed.assessment);
  if (const auto change = focus_.change()) note(*change, in_hand_->assessment);
  remember_judgement();
  const Assessment& found = in_hand_->assessment;
  expectation_.previous_sequence = in_hand_->frame.sequence;
  expectation_.previous_timestamp = in_hand_->frame.sensor_timestamp;
  if (found.face) expectation_.faces.saw(*found.face);
  if (found.verdict == Verdict::accepted) {
    in_hand_->prepared = std::move(assessed.layer);
    return JobEvent::frame_accepted;
  }

  give_up(std::move(assessed));
  log_warning("quality", "layer " + std::to_string(layer_) + ", attempt " +
                             std::to_string(attempt_) + ": " + found.reason);
  unchanged_ = found.face_changed ? 0 : unchanged_ + 1;
  last_rejection_ = found.reason;
  lacks_only_sharpness_ = found.lacks_only_sharpness;
  const std::optional<JobEvent> next = after_rejection(climbed_, unchanged_, settings_.ladder);
  if (lacks_only_sharpness_ &&
      (!best_rejected_ || in_hand_->assessment.sharpness > best_rejected_->assessment.sharpness)) {
    std::swap(best_rejected_, in_hand_);
    focus_of_best_ = focus_memory_;
  }
  // Of two rejected frames the worse is let go, with its record; the better may still be accepted.
  if (in_hand_) reject(*in_hand_);
  in_hand_.reset();
  if (next) {
    focus_again_ = *next == JobEvent::focus_again || *next == JobEvent::clear_again;
    return next;
  }
  // What the last frame shows is how things are now, whatever the frames before it were like.
  if (lacks_only_sharpness_ && may_flag()) {
    in_hand_ = std::exchange(best_rejected_, nullptr);
    focus_memory_ = *focus_of_best_;
    in_hand_->assessment.verdict = Verdict::accepted_with_flag;
    remember_judgement();
    return JobEvent::frame_accepted;
  }
  if (best_rejected_) reject(*std::exchange(best_rejected_, nullptr));
  return JobEvent::attempts_exhausted;
}

/// A focus that is gone does not come back by grinding.
bool LayerCycle::may_flag() const {
  return settings_.ladder.exhausted == LadderSettings::Exhausted::accept &&
         flagged_in_a_row_ < settings_.ladder.flagged_in_a_row;
}

void LayerCycle::remember_judgement() {
  last_judged_ = JudgedAttempt{in_hand_->layer, in_hand_->attempt, in_hand_->assessment.verdict,
                               in_hand_->assessment.slug, in_hand_->assessment.reason};
}

/// The prepared file is removed where files are written: the control thread waits for no disk.
template <typename Prepared>
void LayerCycle::give_up(Prepared prepared) {
  parts_.keeper.post([held = std::make_shared<Prepared>(std::move(prepared))](
                         SampleRecords&) mutable { held.reset(); });
}

void LayerCycle::reject(const JudgedFrame& frame) {
  parts_.keeper.post([frame](SampleRecords& records) { records.record_rejected(frame); });
}

void LayerCycle::begin_storing() {
  if (best_rejected_) reject(*std::exchange(best_rejected_, nullptr));
  stored_ = parts_.keeper.ask([frame = in_hand_](SampleRecords& records) {
    const std::uint64_t bytes = records.commit_layer(*frame);
    return Stored{bytes, records.disk_left_layers()};
  });
}

std::optional<JobEvent> LayerCycle::layer_stored() {
  const Stored stored = stored_.get();
  disk_left_layers_ = stored.disk_left_layers;
  focus_memory_.keep();
  if (const auto& ratio = in_hand_->assessment.sharpness_to_peak) focus_memory_.accepted(*ratio);
  const bool flagged = in_hand_->assessment.verdict == Verdict::accepted_with_flag;
  flagged_in_a_row_ = flagged ? flagged_in_a_row_ + 1 : 0;
  accept_layer(layer_, in_hand_->assessment, flagged, expectation_);
  last_committed_ = CommittedLayer{layer_, in_hand_->attempt, in_hand_->assessment};
  in_hand_.reset();
  parts_.feed.offer(layer_);
  log_info("job", "layer " + std::to_string(layer_) + " of " +
                      std::to_string(settings_.plan.layers) + " is stored, " +
                      std::to_string(stored.bytes) + " bytes");
  if (layer_ == settings_.plan.layers) return JobEvent::nothing_left;
  if (disk_left_layers_ < settings_.limits.disk_reserve_layers) {
    throw DiskFull("the disk has room for " + std::to_string(disk_left_layers_) +
                   " more layers, less than disk_reserve_layers (" +
                   std::to_string(settings_.limits.disk_reserve_layers) + "): make room");
  }
  ++layer_;
  attempt_ = 0;
  climbed_ = 0;
  unchanged_ = 0;
  return JobEvent::layer_committed;
}

void LayerCycle::abandon(const std::string& why) {
  const auto let_go = [why](JudgedFrame frame, SampleRecords& records) {
    frame.assessment.verdict = Verdict::rejected;
    frame.assessment.slug = "abandoned";
    frame.assessment.reason = "the step was abandoned: " + why;
    records.record_rejected(frame);
  };
  focus_.abandon(why);
  if (best_rejected_) reject(*std::exchange(best_rejected_, nullptr));
  if (capture_.valid()) {
    // The worker keeps the order of posting: by then the capture has ended, well or not.
    auto capture = std::make_shared<std::future<JudgedFrame>>(std::move(capture_));
    parts_.keeper.post([capture, let_go](SampleRecords& records) {
      JudgedFrame frame;
      try {
        frame = capture->get();
      } catch (const std::exception& error) {
        log_warning("camera", std::string("the abandoned capture failed: ") + error.what());
        return;
      }
      let_go(std::move(frame), records);
    });
  } else if (in_hand_ && !stored_.valid() && !in_hand_->is_recorded) {
    parts_.keeper.post([frame = std::move(in_hand_), let_go](SampleRecords& records) mutable {
      let_go(*frame, records);
      frame.reset();
    });
  }
  in_hand_.reset();
  if (assessment_.valid()) give_up(std::move(assessment_));
}

std::string LayerCycle::waiting_for(JobState step) const {
  switch (step) {
    case JobState::grinding:
      return grind_.waiting_for();
    case JobState::retracting:
      return retraction_.waiting_for();
    case JobState::clearing:
      return "waits for the air blast";
    case JobState::settling:
      return "waits for vibrations to settle";
    case JobState::lighting:
      return "waits for the lamp";
    case JobState::focusing:
      return focus_.waiting_for();
    case JobState::capturing:
      return "waits for a frame";
    case JobState::assessing:
      return "waits for the assessment";
    case JobState::storing:
      return "waits for the layer to be on disk and its record committed";
    default:
      return "";
  }
}

std::string LayerCycle::why_exhausted() const {
  if (unchanged_ > 0) {
    return "layer " + std::to_string(layer_) + " has no face of its own: " + last_rejection_ +
           ": look at the wheel and the block, then resume";
  }
  return "no frame of layer " + std::to_string(layer_) + " was good enough in " +
         std::to_string(climbed_) + " attempts, at last because " + last_rejection_ +
         why_not_flagged() + ": look at it, then resume";
}

/// Why a policy that accepts has not; empty under another.
std::string LayerCycle::why_not_flagged() const {
  if (settings_.ladder.exhausted != LadderSettings::Exhausted::accept) return "";
  if (!lacks_only_sharpness_) {
    return "; quality.policy accepts a frame that is not quite sharp, and nothing worse";
  }
  return "; quality.flagged_in_a_row allows " + std::to_string(settings_.ladder.flagged_in_a_row) +
         " layers in a row with a flag, and the last " + std::to_string(flagged_in_a_row_) +
         " have one";
}

}  // namespace biotomy::acquisition
