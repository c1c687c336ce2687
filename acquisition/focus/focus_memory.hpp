#pragma once

#include <cstdint>
#include <optional>

#include "acquisition/focus/autofocus.hpp"
#include "firmware_bridge/micrometres.hpp"

namespace biotomy::acquisition {

/// What was learnt of the focus, carried from layer to layer. The face moves away by the layer's
/// thickness with each layer, and the column follows by as much.
class FocusMemory {
 public:
  FocusMemory(const FocusSettings& settings, bridge::Micrometres layer_thickness);

  void remember(std::int64_t layer, Autofocus::Point best);

  /// The sharpness of an accepted frame, as a part of the peak's: when it fell, the next layer
  /// searches.
  void accepted(double sharpness_ratio);

  /// Why `layer` needs a search, in words; null when following is enough.
  const char* why_search(std::int64_t layer) const;

  /// Where the column should be for `layer`.
  bridge::Micrometres predicted(std::int64_t layer) const;

  /// The sharpness at the last peak; 0 when there was no search yet.
  double peak_sharpness() const { return best_ ? best_->sharpness : 0.0; }
  bool knows_focus() const { return best_.has_value(); }

 private:
  FocusSettings settings_;
  bridge::Micrometres layer_thickness_;
  std::int64_t layer_ = 0;
  std::optional<Autofocus::Point> best_;
  bool fell_ = false;
};

}  // namespace biotomy::acquisition
