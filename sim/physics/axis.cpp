#include "sim/physics/axis.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace biotomy::sim {

namespace {

constexpr double kDampings = 5.0;  // time constants of the swing until it counts as settled

/// The swing at a part (0..1) of the settling time: a damped oscillation that begins with 0 and
/// whose first and highest peak is about 1.
double swing(double part) {
  constexpr double kPeak = 0.383;  // of the curve without this factor, at a part of 0.143
  return std::exp(-kDampings * part) * std::sin(2.0 * std::numbers::pi * part) / kPeak;
}

}  // namespace

Axis::Axis(const AxisSettings& settings, double position_um)
    : settings_(settings),
      motor_um_(position_um),
      mechanical_um_(position_um),
      target_um_(position_um),
      speed_um_s_(settings.speed_um_s) {}

void Axis::go_to(double target_um, double speed_um_s) {
  target_um_ = target_um;
  speed_um_s_ = speed_um_s;
  arrived_ = arrived_ && motor_um_ == target_um;
  at_target_s_ = 0;
  direction_ = std::copysign(1.0, target_um - motor_um_);
}

void Axis::halt() {
  motor_um_ = swung_um();
  swing_um_ = 0;
  target_um_ = motor_um_;
  arrived_ = true;
}

void Axis::advance(double seconds) {
  if (!defects_.stalled && !arrived_) {
    const double reach = speed_um_s_ * seconds;
    const bool was_there = motor_um_ == target_um_;
    motor_um_ += std::clamp(target_um_ - motor_um_, -reach, reach);
    at_target_s_ += was_there ? seconds : 0.0;
    arrived_ = motor_um_ == target_um_ && at_target_s_ >= settings_.settling_s;
    swing_um_ = arrived_ || !was_there ? 0.0
                                       : direction_ * settings_.overshoot_um *
                                             swing(at_target_s_ / settings_.settling_s);
  }
  if (!defects_.stalled) {
    motor_um_ += defects_.creep_um_s * seconds;
  }
  mechanical_um_ = std::clamp(mechanical_um_, swung_um(), swung_um() + settings_.backlash_um);
}

}  // namespace biotomy::sim
