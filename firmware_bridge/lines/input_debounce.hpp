#pragma once

#include <chrono>
#include <optional>

namespace biotomy::bridge {

/// Decides whether a safety input counts as active (pressed, open) from what its line showed
/// between two looks. Danger counts at once, safety only when it lasts: any edge since the last
/// look means that the line was not steadily safe, so it counts as active in this look, whatever
/// the level is now, and until the line has then stayed inactive and without an edge for the whole
/// period. Which edge it was, and whether the kernel dropped some, makes no difference.
class InputDebounce {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  explicit InputDebounce(std::chrono::milliseconds period) : period_(period) {}

  /// `had_edges`: since the last look; `is_active`: the level, read after the edges were taken.
  bool look(bool had_edges, bool is_active, TimePoint now);

  /// The line could not be read: what it did is unknown, and so it counts as an edge.
  void doubt(TimePoint now) { unrest_ = now; }

 private:
  std::chrono::milliseconds period_;
  std::optional<TimePoint> unrest_;  ///< the last look that found danger or an edge
};

}  // namespace biotomy::bridge
