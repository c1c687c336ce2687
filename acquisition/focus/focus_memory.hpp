#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "acquisition/focus/autofocus.hpp"
#include "acquisition/focus/focus_settings.hpp"
#include "acquisition/quality/frame_measures.hpp"
#include "firmware_bridge/micrometres.hpp"

namespace biotomy::acquisition {

/// What is remembered of a layer that was focused by a search.
struct FocusedLayer {
  std::int64_t layer = 0;
  bridge::Micrometres position{};
  double sharpness = 0.0;  ///< see sharpness_comparison.hpp
  /// Of the frame at the found position; null after a restart.
  std::shared_ptr<const FrameMeasures> measures;
  /// Of the bracket that suits its curve; zero after a restart.
  bridge::Micrometres step{};
};

/// What was learnt of the focus, carried from layer to layer. The face moves away by the layer's
/// thickness with each layer, and the focus follows by as much, and by what the searches found it
/// to drift beside. A search may find what is not the face, as dirt or a window: what it found
/// counts for its own layer at once, and beyond it only once a frame that was taken there is the
/// layer. While a search finds the focus where it was expected, the next one comes twice as many
/// layers later, up to `every_layers`; where it does not, twice as early.
class FocusMemory {
 public:
  FocusMemory(const FocusSettings& settings, bridge::Micrometres layer_thickness);

  /// What a search found. Until it is kept it can be taken back, together with all that was found
  /// since the last one that was kept.
  void remember(const FocusedLayer& focused);

  /// A frame that was taken at what was remembered last is stored.
  void keep() { kept_.reset(); }

  /// What was not kept is forgotten. Whether there was anything.
  bool take_back();

  /// The sharpness of an accepted frame, as a part of the peak's: when it fell, the next layer
  /// searches.
  void accepted(double sharpness_ratio);

  /// Why `layer` needs a search, in words; null when following is enough.
  const char* why_search(std::int64_t layer) const;

  /// Where the focus should be for `layer`.
  bridge::Micrometres predicted(std::int64_t layer) const;

  /// How a search for `layer` begins. `anywhere`: what was remembered is in doubt.
  SearchPlan plan(std::int64_t layer, bool anywhere) const;

  /// The last frame at a peak, with its layer; null when there was none in this run.
  std::shared_ptr<const FrameMeasures> peak_measures() const {
    return known_.last ? known_.last->measures : nullptr;
  }
  std::int64_t peak_layer() const { return known_.last ? known_.last->layer : 0; }
  bool knows_focus() const { return known_.last.has_value(); }

 private:
  struct Known {
    std::optional<FocusedLayer> last;
    bridge::Micrometres drift{};  ///< a layer
    int wait = 0;                 ///< layers until the next search
    bool fell = false;
  };

  FocusSettings settings_;
  bridge::Micrometres layer_thickness_;
  Known known_;
  std::optional<Known> kept_;  ///< before what was remembered and is not kept yet
};

}  // namespace biotomy::acquisition
