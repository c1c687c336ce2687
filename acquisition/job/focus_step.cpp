#include "acquisition/job/focus_step.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "acquisition/job/capture.hpp"
#include "acquisition/log.hpp"
#include "acquisition/quality/sharpness_comparison.hpp"

namespace biotomy::acquisition {
namespace {

constexpr const char* kComponent = "focus";

void warn_of_lean(const FaceLean& lean, bridge::Micrometres tilt,
                  bridge::Micrometres depth_of_field) {
  std::array<char, 300> text{};
  std::snprintf(text.data(), text.size(),
                "the face leans by %.2f°, %.0f µm across the frame and %.0f µm down it: more than "
                "the depth of field of %.0f µm, so that its corners are not sharp; level the block "
                "or the camera",
                lean.angle_degrees, lean.across.value, lean.down.value, depth_of_field.value);
  if (tilt > depth_of_field) log_warning(kComponent, text.data());
}

}  // namespace

FocusStep::FocusStep(const JobSettings& settings, std::unique_ptr<FocusActuator> actuator,
                     FocusMemory& memory, bridge::Camera& camera, Worker& worker,
                     RecordKeeper& keeper)
    : settings_(settings),
      actuator_(std::move(actuator)),
      memory_(memory),
      camera_(camera),
      worker_(worker),
      keeper_(keeper) {}

void FocusStep::begin(std::int64_t layer, SearchReason reason, TimePoint now) {
  layer_ = layer;
  search_.reset();
  const bridge::AxisLimits limits = actuator_->limits();
  if (reason.words == nullptr) {
    approach(std::clamp(memory_.predicted(layer), limits.minimum, limits.maximum), now);
    return;
  }
  SearchPlan plan = memory_.plan(layer, reason.anywhere);
  plan.predicted = std::clamp(plan.predicted, limits.minimum, limits.maximum);
  focus_ = plan.predicted;
  row_ = {.layer = layer, .why = reason.words, .column = {}, .points = {}, .lean = {}};
  search_.emplace(settings_.focus, plan, limits);
  ask_next(now);
}

void FocusStep::move_to(bridge::Micrometres target, TimePoint now) {
  stands_at_ = target;
  actuator_->move_to(target, now);
}

/// From below, as a search does.
void FocusStep::approach(bridge::Micrometres target, TimePoint now) {
  focus_ = target;
  const bool from_below = stands_at_ && *stands_at_ <= target;
  phase_ = from_below ? Phase::move_to_focus : Phase::take_up_backlash;
  move_to(from_below ? target
                     : std::max(target - settings_.focus.backlash, actuator_->limits().minimum),
          now);
}

void FocusStep::ask_next(TimePoint now) {
  if (const std::optional<Autofocus::Request> request = search_->next()) {
    phase_ = Phase::move_in_search;
    move_to(request->position, now);
  } else {
    end_search(now);
  }
}

bool FocusStep::poll(const bridge::StageStatus& status, TimePoint now) {
  if (phase_ == Phase::in_focus) return true;
  if (phase_ == Phase::measure) {
    if (is_ready(measured_)) take_measures(now);
    return phase_ == Phase::in_focus;
  }
  if (!actuator_->settled(status, now)) return false;
  switch (phase_) {
    case Phase::move_in_search:
      if (search_->next()->measure) {
        take_frame();
      } else {
        search_->arrived();
        ask_next(now);
      }
      return false;
    case Phase::take_up_backlash:
      phase_ = Phase::move_to_focus;
      move_to(focus_, now);
      return false;
    default:
      return true;
  }
}

void FocusStep::take_frame() {
  phase_ = Phase::measure;
  measured_ =
      run_on(worker_, [this_camera = &camera_, time_out = settings_.camera.capture_time_out] {
        return std::make_shared<const FrameMeasures>(
            measure_frame(capture(*this_camera, time_out).image));
      });
}

void FocusStep::take_measures(TimePoint now) {
  std::shared_ptr<const FrameMeasures> measures = measured_.get();
  row_.points.push_back({search_->next()->position, sharpness(*measures)});
  search_->measured(std::move(measures));
  ask_next(now);
}

void FocusStep::end_search(TimePoint now) {
  const std::optional<Autofocus::Found>& found = search_->found();
  report(found);
  if (found) {
    // The frame that confirmed it was taken there.
    memory_.remember({.layer = layer_,
                      .position = found->position,
                      .sharpness = row_.sharpness,
                      .measures = found->measures,
                      .step = found->step});
    phase_ = Phase::in_focus;
    return;
  }
  if (!memory_.knows_focus()) {
    throw StepFailure("no focus was found around " + actuator_->describe(focus_) + " of the " +
                      actuator_->name() + ": " + search_->why_not() +
                      ": check focus.start_um, the lamp and the camera");
  }
  log_warning(kComponent, search_->why_not() + "; the " + actuator_->name() + " follows the face");
  approach(focus_, now);
}

void FocusStep::report(const std::optional<Autofocus::Found>& found) {
  row_.found = found.has_value();
  row_.column = found ? found->position : focus_;
  row_.sharpness = found ? row_.points.back().sharpness : 0.0;
  if (found && found->map) {
    const cv::Size frame = found->measures->grid.frame;
    row_.lean = lean_of(*found->map, static_cast<double>(frame.width) * settings_.plan.pixel_x,
                        static_cast<double>(frame.height) * settings_.plan.pixel_y);
    warn_of_lean(*row_.lean, found->map->tilt(), settings_.focus.depth_of_field);
  }
  last_search_ = FocusReport{.layer = layer_,
                             .why = row_.why,
                             .found = row_.found,
                             .why_not = search_->why_not(),
                             .actuator = actuator_->name(),
                             .position = actuator_->describe(row_.column),
                             .plane = row_.column,
                             .frames = static_cast<int>(row_.points.size()),
                             .lean = row_.lean};
  keeper_.post([row = row_](SampleRecords& records) { records.record_focus(row); });
}

std::string FocusStep::waiting_for() const {
  if (phase_ == Phase::measure) return "waits for a frame of the focus search";
  const std::string moves = std::string("waits for the ") + actuator_->name();
  return search_ ? moves + ", searching the focus" : moves;
}

}  // namespace biotomy::acquisition
