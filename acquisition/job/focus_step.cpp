#include "acquisition/job/focus_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "acquisition/log.hpp"

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

void FocusStep::begin(std::int64_t layer, SearchReason reason,
                      const std::optional<CameraNoise>& noise, TimePoint now) {
  layer_ = layer;
  search_.reset();
  expected_.reset();
  if (memory_.knows_focus()) expected_ = memory_.plan(layer, false);
  if (reason.words == nullptr) {
    const bridge::AxisLimits limits = actuator_->limits();
    approach(std::clamp(memory_.predicted(layer), limits.minimum, limits.maximum), now);
    return;
  }
  why_ = reason.words;
  phase_ = Phase::search;
  SearchPlan plan = memory_.plan(layer, reason.anywhere);
  plan.noise = noise;
  search_.emplace(settings_, plan, SearchParts{*actuator_, camera_, worker_}, now);
  focus_ = search_->predicted();
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

bool FocusStep::poll(const bridge::StageStatus& status, TimePoint now) {
  switch (phase_) {
    case Phase::search:
      if (search_->poll(status, now)) end_search(now);
      return phase_ == Phase::in_focus;
    case Phase::take_up_backlash:
      if (!actuator_->settled(status, now)) return false;
      phase_ = Phase::move_to_focus;
      move_to(focus_, now);
      return false;
    case Phase::move_to_focus:
      return actuator_->settled(status, now);
    case Phase::in_focus:
      return true;
  }
  return false;
}

// The worker keeps the order of posting: by then the frame under way was taken, or was not.
void FocusStep::abandon(const std::string& why) {
  if (!search_ || phase_ != Phase::search || search_->has_ended()) return;
  FocusRow row{.layer = layer_,
               .why = std::string(why_) + "; broken off: " + why,
               .column = focus_,
               .points = search_->points()};
  keeper_.post([row, last_point = search_->break_off()](SampleRecords& records) mutable {
    if (const auto last = last_point()) row.points.push_back(*last);
    if (!row.points.empty()) records.record_focus(row);
  });
}

void FocusStep::end_search(TimePoint now) {
  stands_at_ = search_->stands_at();
  report();
  if (const std::optional<Autofocus::Found>& found = search_->found()) {
    // The frame that confirmed it was taken there. Whether it stays remembered is decided by the
    // layer's frame.
    memory_.remember({.layer = layer_,
                      .position = found->position,
                      .sharpness = search_->points().back().sharpness,
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

std::optional<Metric> FocusStep::change() const {
  if (!expected_) return std::nullopt;
  const bool was_found = search_ && search_->found();
  const bridge::Micrometres focus = was_found ? search_->found()->position : focus_;
  const double limit = settings_.focus.largest_change.value;  // a layer
  const double layers = expected_->largest_change->value / limit;
  const double value = (focus - expected_->predicted).value / layers;
  return Metric{"focus_change", value, limit, std::abs(value) <= limit};
}

void FocusStep::report() {
  const std::optional<Autofocus::Found>& found = search_->found();
  const FocusRow row{.layer = layer_,
                     .why = why_,
                     .column = found ? found->position : focus_,
                     .sharpness = found ? search_->points().back().sharpness : 0.0,
                     .found = found.has_value(),
                     .points = search_->points(),
                     .lean = search_->lean()};
  if (row.lean) warn_of_lean(*row.lean, found->map->tilt(), settings_.focus.depth_of_field);
  last_search_ = FocusReport{.layer = layer_,
                             .why = row.why,
                             .found = row.found,
                             .why_not = search_->why_not(),
                             .actuator = actuator_->name(),
                             .position = actuator_->describe(row.column),
                             .plane = row.column,
                             .frames = static_cast<int>(row.points.size()),
                             .lean = row.lean};
  keeper_.post([row](SampleRecords& records) { records.record_focus(row); });
}

std::string FocusStep::waiting_for() const {
  if (phase_ == Phase::search && search_->waits_for_frame()) {
    return "waits for a frame of the focus search";
  }
  const std::string moves = std::string("waits for the ") + actuator_->name();
  return search_ ? moves + ", searching the focus" : moves;
}

}  // namespace biotomy::acquisition
