#pragma once

#include "sim/physics/mechanics.hpp"

namespace biotomy::sim {

/// What a drive may do for how long before it counts as a fault.
struct DriveLimits {
  double still_s = 0.5;            ///< told to move, and not moving
  double following_error_um = 20;  ///< away from where it should stand
  double overload_percent = 120;   ///< of the rated torque
  double overload_s = 0.3;
};

/// Watches whether axes and spindle do what they are told. Rig time.
class DriveMonitor {
 public:
  explicit DriveMonitor(const DriveLimits& limits) : limits_(limits) {}

  /// To be called after each step of the mechanics.
  void watch(const Mechanics& mechanics, double seconds);

  /// A drive does not move, not stand, or not turn as it was told, and has not for its time limit.
  bool disobeyed() const;

  /// The spindle bears more than it should, and has for its time limit.
  bool overloaded() const { return overloaded_s_ > limits_.overload_s; }

 private:
  struct Follower {
    double seen = 0;
    double wrong_s = 0;  ///< how long it has not done as it was told
    void watch(double value, bool wrong_at_rest, bool under_way, double seconds);
  };
  void watch(Follower& follower, const Axis& axis, double seconds) const;

  DriveLimits limits_;
  Follower feed_;
  Follower traverse_;
  Follower column_;
  Follower spindle_;
  double overloaded_s_ = 0;
};

}  // namespace biotomy::sim
