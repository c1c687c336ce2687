#include "acquisition/focus/focus_memory.hpp"

#include <algorithm>
#include <cmath>

namespace biotomy::acquisition {
namespace {

/// The part of a deviation that counts as drift: the rest is taken for chance.
constexpr double kLearnt = 0.5;

/// The focus is where it was expected when it is off by less than this part of the depth of field.
constexpr double kAsExpected = 1.0 / 16.0;

constexpr int kFirstWait = 5;  // layers: the drift is not known yet

}  // namespace

FocusMemory::FocusMemory(const FocusSettings& settings, bridge::Micrometres layer_thickness)
    : settings_(settings),
      layer_thickness_(layer_thickness),
      wait_(std::min(kFirstWait, settings.every_layers)) {}

void FocusMemory::remember(const FocusedLayer& focused) {
  if (last_ && focused.layer > last_->layer) {
    const auto layers = static_cast<double>(focused.layer - last_->layer);
    const bridge::Micrometres deviation = focused.position - predicted(focused.layer);
    const bool is_expected =
        std::abs(deviation.value) <= kAsExpected * settings_.depth_of_field.value;
    wait_ = std::clamp(is_expected ? 2 * wait_ : wait_ / 2, 1, settings_.every_layers);
    // A leap is a new beginning, not a drift.
    if (std::abs(deviation.value) <= settings_.largest_change.value) {
      drift_ = drift_ + (kLearnt / layers) * deviation;
    }
  }
  last_ = focused;
  fell_ = false;
}

void FocusMemory::accepted(double sharpness_ratio) {
  fell_ = sharpness_ratio < settings_.search_below_ratio;
}

const char* FocusMemory::why_search(std::int64_t layer) const {
  if (!last_) return "no focus is known yet";
  if (fell_) return "the sharpness fell";
  if (layer - last_->layer >= wait_) return "the last search is long ago";
  return nullptr;
}

bridge::Micrometres FocusMemory::predicted(std::int64_t layer) const {
  if (!last_) return settings_.start;
  return last_->position + static_cast<double>(layer - last_->layer) * (layer_thickness_ + drift_);
}

SearchPlan FocusMemory::plan(std::int64_t layer, bool anywhere) const {
  SearchPlan plan{.predicted = predicted(layer), .step = settings_.step, .largest_change = {}};
  if (!last_) return plan;
  plan.step = std::max(plan.step, last_->step);
  if (!anywhere) {
    const std::int64_t layers = std::max<std::int64_t>(1, layer - last_->layer);
    plan.largest_change = static_cast<double>(layers) * settings_.largest_change;
  }
  return plan;
}

}  // namespace biotomy::acquisition
