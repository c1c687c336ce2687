#pragma once

#include <algorithm>
#include <cmath>

namespace biotomy::sim {

/// A positioned axis: it goes to its target at no more than its speed. Micrometres and seconds.
class Axis {
 public:
  explicit Axis(double speed_um_s, double position_um = 0.0)
      : position_um_(position_um), target_um_(position_um), speed_um_s_(speed_um_s) {}

  void go_to(double target_um, double speed_um_s) {
    target_um_ = target_um;
    speed_um_s_ = speed_um_s;
  }
  void halt() { target_um_ = position_um_; }

  void advance(double seconds) {
    const double reach = speed_um_s_ * seconds;
    position_um_ += std::clamp(target_um_ - position_um_, -reach, reach);
  }

  double position_um() const { return position_um_; }
  double target_um() const { return target_um_; }
  bool arrived() const { return position_um_ == target_um_; }

  /// Signed; 0 once it has arrived.
  double velocity_um_s() const {
    return arrived() ? 0.0 : std::copysign(speed_um_s_, target_um_ - position_um_);
  }

 private:
  double position_um_;
  double target_um_;
  double speed_um_s_;
};

}  // namespace biotomy::sim
