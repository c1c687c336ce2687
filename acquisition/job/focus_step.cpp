#include "acquisition/job/focus_step.hpp"

#include <algorithm>

#include "acquisition/job/capture.hpp"
#include "acquisition/job/parking.hpp"
#include "acquisition/log.hpp"
#include "acquisition/quality/sharpness.hpp"

namespace biotomy::acquisition {

FocusStep::FocusStep(const JobSettings& settings, bridge::AxisLimits column, FocusMemory& memory,
                     StageCommands& commands, bridge::Camera& camera, Worker& worker,
                     RecordKeeper& keeper)
    : settings_(settings),
      column_(column),
      memory_(memory),
      commands_(commands),
      camera_(camera),
      worker_(worker),
      keeper_(keeper) {}

void FocusStep::begin(std::int64_t layer, const char* why_search, TimePoint now) {
  layer_ = layer;
  focus_ = std::clamp(memory_.predicted(layer), column_.minimum, column_.maximum);
  search_.reset();
  if (why_search == nullptr) {
    phase_ = Phase::move_to_focus;
    move_to(focus_, now);
    return;
  }
  why_ = why_search;
  search_.emplace(settings_.focus, focus_, column_);
  ask_next(now);
}

void FocusStep::move_to(bridge::Micrometres column, TimePoint now) {
  target_ = column;
  commands_.begin({.action = bridge::StageAction::move_column,
                   .position = column,
                   .duration = {},
                   .spindle_rpm = 0.0},
                  now);
}

void FocusStep::ask_next(TimePoint now) {
  if (const std::optional<Autofocus::Request> request = search_->next()) {
    phase_ = Phase::move_in_search;
    move_to(request->column, now);
  } else {
    end_search(now);
  }
}

bool FocusStep::poll(const bridge::StageStatus& status, TimePoint now) {
  if (phase_ == Phase::measure) {
    if (!is_ready(sharpness_)) return false;
    search_->measured(sharpness_.get());
    ask_next(now);
    return false;
  }
  if (!commands_.poll_done(status, now)) return false;
  check_position("column", status.column, target_, settings_.limits);
  switch (phase_) {
    case Phase::move_in_search:
      if (search_->next()->measure) {
        phase_ = Phase::measure;
        sharpness_ =
            run_on(worker_, [this_camera = &camera_, time_out = settings_.camera.capture_time_out] {
              return sharpness(capture(*this_camera, time_out).image);
            });
      } else {
        search_->arrived();
        ask_next(now);
      }
      return false;
    case Phase::take_up_backlash:
      phase_ = Phase::move_to_focus;
      move_to(focus_, now);
      return false;
    case Phase::move_to_focus:
    case Phase::measure:
      return true;
  }
  return false;
}

void FocusStep::end_search(TimePoint now) {
  const std::optional<Autofocus::Point> best = search_->best();
  FocusRow row{.layer = layer_,
               .why = why_,
               .column = best ? best->column : focus_,
               .sharpness = best ? best->sharpness : 0.0,
               .found = best.has_value(),
               .points = {}};
  for (const Autofocus::Point& point : search_->points()) {
    row.points.push_back({point.column, point.sharpness});
  }
  keeper_.post([row](SampleRecords& records) { records.record_focus(row); });

  if (best) {
    memory_.remember(layer_, *best);
    focus_ = best->column;
  } else if (!memory_.knows_focus()) {
    throw StepFailure("no focus was found around " + std::to_string(focus_.value) +
                      " µm of the column: check focus.start_um, the lamp and the camera");
  } else {
    log_warning("focus", "no peak was found; the column follows the face");
  }
  phase_ = Phase::take_up_backlash;
  move_to(std::max(focus_ - settings_.focus.backlash, column_.minimum), now);
}

std::string FocusStep::waiting_for() const {
  if (phase_ == Phase::measure) return "waits for a frame of the focus search";
  return search_ ? "waits for the column, searching the focus" : "waits for the column";
}

}  // namespace biotomy::acquisition
