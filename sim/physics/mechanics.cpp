#include "sim/physics/mechanics.hpp"

#include <algorithm>
#include <cmath>

namespace biotomy::sim {

namespace {

constexpr double kIdleLoadPercent = 6.0;
constexpr double kLoadPercentPerMicrometre = 0.35;
constexpr double kIdleVibration = 0.15;  // mm/s at 3000 rpm
constexpr double kCuttingVibration = 0.9;
constexpr double kWarmingPerSecond = 0.02;  // degrees while the wheel cuts
constexpr double kCoolingTimeConstantSeconds = 60;

}  // namespace

Mechanics::Mechanics(const MechanicsSettings& settings, const Block& block)
    : feed(settings.feed_speed_um_s),
      traverse(settings.traverse_speed_um_s),
      column(settings.column_speed_um_s),
      settings_(settings),
      block_(block),
      block_temperature_c_(settings.block_temperature_c) {}

void Mechanics::advance(double seconds) {
  const double spin = settings_.spindle_acceleration_rpm_s * seconds;
  spindle_rpm_ += std::clamp(spindle_target_rpm_ - spindle_rpm_, -spin, spin);
  feed.advance(seconds);
  column.advance(seconds);
  const double traverse_before_um = traverse.position_um();
  traverse.advance(seconds);
  grind(traverse_before_um);
  if (air_on_) {
    block_.blow(1e3 * seconds);
  }
  const double away = block_temperature_c_ - settings_.block_temperature_c;
  block_temperature_c_ += (cutting() ? kWarmingPerSecond * seconds : 0.0) -
                          away * std::min(1.0, seconds / kCoolingTimeConstantSeconds);
}

void Mechanics::grind(double traverse_before_um) {
  const double now_um = traverse.position_um();
  const bool forward = now_um > traverse_before_um;
  const bool over_face = now_um > face_begin_um() && traverse_before_um < face_end_um();
  if (!forward || !over_face || spindle_rpm_ <= 0.0) {
    cut_depth_um_ = 0.0;
    return;
  }
  if (traverse_before_um <= face_begin_um()) {
    if (feed.position_um() <= block_.shallowest_um()) {
      return;  // the wheel goes over it in the air
    }
    cut_depth_um_ = feed.position_um() - block_.shallowest_um();
    block_.begin_pass(feed.position_um());
  }
  if (cutting()) {
    block_.cut_to((now_um - face_begin_um()) / settings_.face_width_um);
  }
}

double Mechanics::spindle_load_percent() const {
  if (spindle_rpm_ <= 0.0) {
    return 0.0;
  }
  return std::min(kIdleLoadPercent + kLoadPercentPerMicrometre * cut_depth_um_, 100.0);
}

double Mechanics::vibration_mm_s() const {
  return spindle_rpm_ / 3000.0 * (kIdleVibration + (cutting() ? kCuttingVibration : 0.0));
}

void Mechanics::restore(const Block::State& block, double feed_um, double traverse_um,
                        double column_um) {
  block_.restore(block);
  feed = Axis(settings_.feed_speed_um_s, feed_um);
  traverse = Axis(settings_.traverse_speed_um_s, traverse_um);
  column = Axis(settings_.column_speed_um_s, column_um);
}

}  // namespace biotomy::sim
