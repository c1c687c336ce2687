#include "sim/physics/mechanics.hpp"

#include <algorithm>
#include <cmath>

namespace biotomy::sim {

namespace {

constexpr double kIdleLoadPercent = 6.0;
constexpr double kLoadPercentPerMicrometre = 0.35;  // at kRatedSpeed
constexpr double kRatedSpeedUmS = 6000;             // of the block under the wheel
constexpr double kIdleVibration = 0.15;             // mm/s at 3000 rpm
constexpr double kCuttingVibration = 0.9;
constexpr double kCubicMillimetre = 1e9;  // µm³

}  // namespace

Mechanics::Mechanics(const MechanicsSettings& settings, const Block& block)
    : feed(settings.feed),
      traverse(settings.traverse),
      column(settings.column),
      settings_(settings),
      block_(block),
      climate_(settings.climate) {}

void Mechanics::set_defects(const MachineDefects& defects) {
  defects_ = defects;
  feed.set_defects(defects.feed);
  traverse.set_defects(defects.traverse);
  column.set_defects(defects.column);
}

void Mechanics::advance(double seconds) {
  spin(seconds);
  feed.advance(seconds);
  column.advance(seconds);
  const double traverse_before_um = traverse.mechanical_um();
  traverse.advance(seconds);
  traverse_speed_um_s_ = (traverse.mechanical_um() - traverse_before_um) / seconds;
  grind(traverse_before_um);
  shake(seconds);
  if (air_on_ && !defects_.air_blocked) {
    block_.blow(1e3 * seconds);
  }
  climate_.advance(seconds, cutting(), defects_.cooler_failed_s);
}

void Mechanics::spin(double seconds) {
  const double reach = settings_.spindle_acceleration_rpm_s * seconds;
  const double asked =
      defects_.spindle_runs_on ? std::max(spindle_rpm_, spindle_target_rpm_) : spindle_target_rpm_;
  const double target = defects_.spindle_blocked ? 0.0 : asked;
  spindle_rpm_ += std::clamp(target - spindle_rpm_, -reach, reach);
}

void Mechanics::shake(double seconds) {
  const double shaken_mm_s =
      defects_.extra_vibration_mm_s +
      spindle_rpm_ / 3000.0 * (kIdleVibration + (cutting() ? kCuttingVibration : 0.0));
  const bool decays = shaken_mm_s < vibration_mm_s_ && settings_.vibration_decay_s > 0.0;
  vibration_mm_s_ += (shaken_mm_s - vibration_mm_s_) *
                     (decays ? std::min(1.0, seconds / settings_.vibration_decay_s) : 1.0);
}

void Mechanics::grind(double traverse_before_um) {
  const double now_um = traverse.mechanical_um();
  const bool forward = now_um > traverse_before_um;
  const bool over_face = now_um > face_begin_um() && traverse_before_um < face_end_um();
  if (!forward || !over_face || spindle_rpm_ <= 0.0) {
    cut_depth_um_ = 0.0;
    return;
  }
  if (traverse_before_um <= face_begin_um()) {
    const double depth_um = feed.mechanical_um() - wheel_worn_um_ - defects_.wheel_short_um;
    if (depth_um <= block_.shallowest_um()) {
      return;  // the wheel goes over it in the air
    }
    cut_depth_um_ = depth_um - block_.shallowest_um();
    block_.begin_pass(depth_um);
  }
  if (cutting()) {
    const double before_um = block_.mean_um();
    block_.cut_to((now_um - face_begin_um()) / settings_.face_width_um);
    const double removed_mm3 = (block_.mean_um() - before_um) * settings_.face_width_um *
                               settings_.face_height_um / kCubicMillimetre;
    wheel_worn_um_ += removed_mm3 * settings_.wheel_wear_um_mm3;
  }
}

double Mechanics::spindle_load_percent() const {
  if (spindle_rpm_ <= 0.0) {
    return 0.0;
  }
  const double cutting_percent = kLoadPercentPerMicrometre * cut_depth_um_ *
                                 (traverse_speed_um_s_ / kRatedSpeedUmS) *
                                 (1.0 + settings_.load_per_wear_um * wheel_worn_um_);
  return kIdleLoadPercent + cutting_percent + defects_.extra_load_percent;
}

Mechanics::State Mechanics::state() const {
  return {block_.state(), feed.motor_um(), traverse.motor_um(), column.motor_um(), wheel_worn_um_};
}

void Mechanics::restore(const State& state) {
  block_.restore(state.block);
  feed = Axis(settings_.feed, state.feed_um);
  traverse = Axis(settings_.traverse, state.traverse_um);
  column = Axis(settings_.column, state.column_um);
  wheel_worn_um_ = state.wheel_worn_um;
}

}  // namespace biotomy::sim
