#include "acquisition/rig/focus_search.hpp"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "acquisition/log.hpp"
#include "acquisition/quality/sharpness_comparison.hpp"
#include "acquisition/rig/capture.hpp"

namespace biotomy::acquisition {
namespace {

SearchPlan within(SearchPlan plan, const bridge::AxisLimits& limits) {
  plan.predicted = std::clamp(plan.predicted, limits.minimum, limits.maximum);
  return plan;
}

}  // namespace

FocusSearch::FocusSearch(const JobSettings& settings, SearchPlan plan, const SearchParts& parts,
                         TimePoint now)
    : settings_(settings),
      plan_(within(plan, parts.actuator.limits())),
      parts_(parts),
      begun_(now),
      autofocus_(settings.focus, plan_, parts.actuator.limits()) {
  ask_next(now);
}

bool FocusSearch::ask_next(TimePoint now) {
  const auto limit = settings_.focus.time_limit;
  if (autofocus_.next() && now - begun_ > limit) {
    autofocus_.give_up("the search took longer than focus.time_limit_ms, " +
                       std::to_string(limit.count()) + " ms");
  }
  const std::optional<Autofocus::Request> request = autofocus_.next();
  if (!request) return false;
  stands_at_ = request->position;
  parts_.actuator.move_to(request->position, now);
  return true;
}

bool FocusSearch::poll(const bridge::StageStatus& status, TimePoint now) {
  if (has_ended()) return true;
  if (measured_.valid()) {
    if (!is_ready(measured_)) return false;
    take_measures();
    return !ask_next(now);
  }
  if (!parts_.actuator.settled(status, now)) return false;
  if (autofocus_.next()->measure) {
    take_frame(status);
    return false;
  }
  autofocus_.arrived();
  return !ask_next(now);
}

void FocusSearch::take_frame(const bridge::StageStatus& status) {
  measured_at_ = parts_.actuator.reported(status).value_or(autofocus_.next()->position);
  measured_ = run_on(parts_.worker, [camera = &parts_.camera, noise = plan_.noise,
                                     time_out = settings_.camera.capture_time_out] {
    const FrameMeasures measures = measure_frame(capture(*camera, time_out).image);
    return std::make_shared<const FrameMeasures>(noise ? with_noise(measures, *noise) : measures);
  });
}

void FocusSearch::take_measures() {
  std::shared_ptr<const FrameMeasures> measures = measured_.get();
  points_.push_back({measured_at_, sharpness(*measures)});
  autofocus_.measured(std::move(measures));
}

std::function<std::optional<FocusRow::Point>()> FocusSearch::break_off() {
  autofocus_.give_up("it was broken off");
  if (!measured_.valid()) return [] { return std::nullopt; };
  return [at = measured_at_, measured = measured_.share()]() -> std::optional<FocusRow::Point> {
    try {
      return FocusRow::Point{at, sharpness(*measured.get())};
    } catch (const std::exception& error) {
      log_warning("focus", std::string("the last frame of the search failed: ") + error.what());
      return std::nullopt;
    }
  };
}

std::optional<FaceLean> FocusSearch::lean() const {
  if (!found() || !found()->map) return std::nullopt;
  const cv::Size frame = found()->measures->grid.frame;
  return lean_of(*found()->map, static_cast<double>(frame.width) * settings_.plan.pixel_x,
                 static_cast<double>(frame.height) * settings_.plan.pixel_y);
}

}  // namespace biotomy::acquisition
