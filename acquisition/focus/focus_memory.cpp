#include "acquisition/focus/focus_memory.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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
      known_{.last = {}, .wait = std::min(kFirstWait, settings.every_layers)} {}

void FocusMemory::remember(const FocusedLayer& focused) {
  if (!kept_) kept_ = known_;
  if (known_.last && focused.layer > known_.last->layer) {
    const auto layers = static_cast<double>(focused.layer - known_.last->layer);
    const bridge::Micrometres deviation = focused.position - predicted(focused.layer);
    const bool is_expected =
        std::abs(deviation.value) <= kAsExpected * settings_.depth_of_field.value;
    known_.wait =
        std::clamp(is_expected ? 2 * known_.wait : known_.wait / 2, 1, settings_.every_layers);
    // A leap is a new beginning, not a drift.
    if (std::abs(deviation.value) <= settings_.largest_change.value) {
      known_.drift = known_.drift + (kLearnt / layers) * deviation;
    }
  }
  known_.last = focused;
  known_.fell = false;
}

bool FocusMemory::take_back() {
  if (!kept_) return false;
  known_ = *std::exchange(kept_, std::nullopt);
  return true;
}

void FocusMemory::accepted(double sharpness_ratio) {
  known_.fell = sharpness_ratio < settings_.search_below_ratio;
}

const char* FocusMemory::why_search(std::int64_t layer) const {
  if (!known_.last) return "no focus is known yet";
  if (known_.fell) return "the sharpness fell";
  if (layer - known_.last->layer >= known_.wait) return "the last search is long ago";
  return nullptr;
}

bridge::Micrometres FocusMemory::predicted(std::int64_t layer) const {
  if (!known_.last) return settings_.start;
  return known_.last->position +
         static_cast<double>(layer - known_.last->layer) * (layer_thickness_ + known_.drift);
}

SearchPlan FocusMemory::plan(std::int64_t layer, bool anywhere) const {
  SearchPlan plan{.predicted = predicted(layer), .step = settings_.step, .largest_change = {}};
  if (!known_.last) return plan;
  plan.step = std::max(plan.step, known_.last->step);
  if (!anywhere) {
    const std::int64_t layers = std::max<std::int64_t>(1, layer - known_.last->layer);
    plan.largest_change = static_cast<double>(layers) * settings_.largest_change;
  }
  return plan;
}

}  // namespace biotomy::acquisition
