#include "acquisition/rig/motion_watch.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace biotomy::acquisition {
namespace {

constexpr double kSpindleStirsRpm = 5.0;

template <typename... Values>
std::string sentence(const char* format, Values... values) {
  std::array<char, 240> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

}  // namespace

MotionWatch::MotionWatch(const SafetyLimits& limits) : limits_(limits) {}

void MotionWatch::forget() {
  at_rest_.reset();
  stays_.reset();
  stir_.reset();
  cause_.reset();
}

MotionWatch::Axes MotionWatch::axes_of(const bridge::StageStatus& status) {
  return {Axis{"feed", status.feed, status.feed_target},
          Axis{"traverse", status.traverse, status.traverse_target},
          Axis{"column", status.column, status.column_target}};
}

bool MotionWatch::near(bridge::Micrometres a, bridge::Micrometres b) const {
  return std::abs((a - b).value) <= limits_.position_tolerance.value;
}

void MotionWatch::observe(const bridge::StageStatus& status, TimePoint now) {
  const Axes axes = axes_of(status);
  cause_.reset();
  // A short command begins and ends between two looks, both of which find an idle controller.
  if (std::exchange(last_command_, status.sequence_started) != status.sequence_started) {
    at_rest_.reset();
  }
  switch (status.state) {
    case bridge::ControllerState::idle:
      stays_.reset();
      stir_.reset();
      cause_ = drifted(axes);
      return;
    case bridge::ControllerState::busy:
      at_rest_.reset();
      cause_ = stalled(axes, now);
      if (const auto still = standing_still(status, now); !cause_) cause_ = still;
      return;
    case bridge::ControllerState::booting:
    case bridge::ControllerState::faulted:
      forget();  // it halts or retracts by its own rules
      return;
  }
}

std::optional<std::string> MotionWatch::drifted(const Axes& axes) {
  if (!at_rest_) at_rest_ = axes;
  for (std::size_t i = 0; i < kAxes; ++i) {
    const bridge::Micrometres left_at = (*at_rest_)[i].position;
    if (near(axes[i].position, left_at)) continue;
    return sentence("the %s moves by itself: it was left at %.1f µm and is at %.1f µm",
                    axes[i].name, left_at.value, axes[i].position.value);
  }
  return std::nullopt;
}

std::optional<std::string> MotionWatch::stalled(const Axes& axes, TimePoint now) {
  if (!stays_) {
    stays_.emplace();
    for (std::size_t i = 0; i < kAxes; ++i) (*stays_)[i] = {axes[i].position, now};
  }
  for (std::size_t i = 0; i < kAxes; ++i) {
    const Axis& axis = axes[i];
    Stay& stay = (*stays_)[i];
    if (!near(axis.position, stay.position) || near(axis.position, axis.target)) {
      stay = {axis.position, now};
    } else if (now - stay.since >= limits_.axis_stall) {
      return sentence(
          "the %s stands still at %.1f µm on its way to %.1f µm: look for what holds it", axis.name,
          axis.position.value, axis.target.value);
    }
  }
  return std::nullopt;
}

std::optional<std::string> MotionWatch::standing_still(const bridge::StageStatus& status,
                                                       TimePoint now) {
  const Axes axes = axes_of(status);
  const bool stirs = !stir_ || status.air_on || !same_places(axes, stir_->axes) ||
                     std::abs(status.spindle_rpm - stir_->spindle_rpm) >= kSpindleStirsRpm;
  if (stirs) stir_ = {axes, status.spindle_rpm, now};
  if (now - stir_->at < limits_.standstill) return std::nullopt;
  return "a command is under way and nothing moves: look at the drives and the spindle";
}

bool MotionWatch::same_places(const Axes& a, const Axes& b) const {
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (!near(a[i].position, b[i].position)) return false;
  }
  return true;
}

}  // namespace biotomy::acquisition
