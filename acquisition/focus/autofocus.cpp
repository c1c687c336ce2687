#include "acquisition/focus/autofocus.hpp"

#include <algorithm>
#include <iterator>

namespace biotomy::acquisition {

Autofocus::Autofocus(const FocusSettings& settings, bridge::Micrometres predicted,
                     bridge::AxisLimits column)
    : settings_(settings), column_(column), shifts_left_(settings.shifts) {
  begin_sweep(predicted);
}

void Autofocus::begin_sweep(bridge::Micrometres centre) {
  const bridge::Micrometres span = static_cast<double>(settings_.points - 1) * settings_.step;
  first_ = centre - 0.5 * span;
  first_ = std::min(first_, column_.maximum - span);
  first_ = std::max(first_, column_.minimum);
  measured_ = 0;
  approached_ = false;
}

std::optional<Autofocus::Request> Autofocus::next() const {
  if (ended_) return std::nullopt;
  if (!approached_) {
    return Request{std::max(first_ - settings_.backlash, column_.minimum), false};
  }
  return Request{first_ + static_cast<double>(measured_) * settings_.step, true};
}

void Autofocus::arrived() {
  approached_ = true;
}

void Autofocus::measured(double sharpness) {
  points_.push_back({next()->column, sharpness});
  ++measured_;
  if (measured_ == settings_.points) end_sweep();
}

void Autofocus::end_sweep() {
  const auto begin = points_.end() - settings_.points;
  const auto peak = std::max_element(
      begin, points_.end(),
      [](const Point& left, const Point& right) { return left.sharpness < right.sharpness; });
  const bool at_left = peak == begin;
  const bool at_right = std::next(peak) == points_.end();
  if (!at_left && !at_right) {
    best_ = parabola_peak(*std::prev(peak), *peak, *std::next(peak));
    ended_ = true;
    return;
  }
  const bool can_move = at_left ? first_ > column_.minimum
                                : points_.back().column + settings_.step <= column_.maximum;
  if (shifts_left_ == 0 || !can_move) {
    ended_ = true;
    return;
  }
  --shifts_left_;
  begin_sweep(peak->column);
}

Autofocus::Point parabola_peak(Autofocus::Point left, Autofocus::Point middle,
                               Autofocus::Point right) {
  const double curvature = left.sharpness - 2.0 * middle.sharpness + right.sharpness;
  if (curvature >= 0.0) return middle;  // a plateau
  const double slope = right.sharpness - left.sharpness;
  const double steps = -0.5 * slope / curvature;
  const bridge::Micrometres step = 0.5 * (right.column - left.column);
  return {middle.column + steps * step, middle.sharpness - 0.125 * slope * slope / curvature};
}

}  // namespace biotomy::acquisition
