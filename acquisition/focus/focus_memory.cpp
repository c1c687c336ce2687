#include "acquisition/focus/focus_memory.hpp"

namespace biotomy::acquisition {

FocusMemory::FocusMemory(const FocusSettings& settings, bridge::Micrometres layer_thickness)
    : settings_(settings), layer_thickness_(layer_thickness) {}

void FocusMemory::remember(std::int64_t layer, Autofocus::Point best) {
  layer_ = layer;
  best_ = best;
  fell_ = false;
}

void FocusMemory::accepted(double sharpness_ratio) {
  fell_ = sharpness_ratio < settings_.search_below_ratio;
}

const char* FocusMemory::why_search(std::int64_t layer) const {
  if (!best_) return "no focus is known yet";
  if (fell_) return "the sharpness fell";
  if (layer - layer_ >= settings_.every_layers) return "the last search is long ago";
  return nullptr;
}

bridge::Micrometres FocusMemory::predicted(std::int64_t layer) const {
  if (!best_) return settings_.start;
  return best_->column + static_cast<double>(layer - layer_) * layer_thickness_;
}

}  // namespace biotomy::acquisition
