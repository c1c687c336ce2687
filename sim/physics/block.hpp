#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace biotomy::sim {

/// A chip that a pass left on the face. Places are parts of the face's width and height.
struct Speck {
  float x = 0;
  float y = 0;
  float radius_um = 0;
};

struct DebrisSettings {
  int specks = 40;        ///< left by a pass
  double radius_um = 60;  ///< of the largest
  double hold_ms = 600;   ///< the air blast after which even the stickiest speck is gone
};

/// The frozen block as it stands under the wheel: how deep each part of its face is, and what lies
/// on it. The wheel goes over the face from x = 0 to the far side; a pass that was broken off
/// leaves a step. Depths are feed positions, micrometres, growing into the block.
class Block {
 public:
  static constexpr std::size_t kStrips = 32;  ///< of equal width across the face, along x

  /// All that a restart of the twin must not forget.
  struct State {
    std::array<double, kStrips> strip_depth_um{};
    std::uint32_t passes = 0;  ///< that touched the face, broken off or not
    double blown_ms = 0;       ///< air over the face since the last pass
  };

  Block(std::uint64_t seed, double face_um, double roughness_um, const DebrisSettings& debris);

  /// The wheel comes down for a pass with the feed axis at `feed_um`. The depth that it will reach
  /// differs from it by a normally distributed error of `roughness_um`, never by more than three.
  void begin_pass(double feed_um);

  /// The wheel has passed over the part from 0 to `share` (0..1) of the face: what stood above its
  /// depth is gone; what was deeper stays.
  void cut_to(double share);

  /// Air over the face.
  void blow(double milliseconds) { state_.blown_ms += milliseconds; }

  /// Of the strips, in order of x.
  const std::array<double, kStrips>& strip_depth_um() const { return state_.strip_depth_um; }
  double shallowest_um() const;
  double deepest_um() const;
  double mean_um() const;

  /// What lies on the face now: nothing before the first pass, less the longer air blew.
  std::vector<Speck> debris() const;

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

 private:
  std::uint64_t seed_;
  double roughness_um_;
  DebrisSettings debris_;
  State state_;
  double pass_depth_um_;
};

}  // namespace biotomy::sim
