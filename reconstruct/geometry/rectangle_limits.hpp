#pragma once

#include <span>

namespace biotomy::reconstruct {

/// A width and a height, micrometres.
struct RectangleShape {
  double width = 0.0;
  double height = 0.0;

  double area() const { return width * height; }
};

/// What keeps a rectangle small: a·width + b·height ≤ c, with a and b not below 0 and not both 0.
struct RectangleLimit {
  double a = 0.0;
  double b = 0.0;
  double c = 0.0;
};

/// The shape of the greatest area that keeps within all limits; exact to rounding. Without area
/// when a limit allows none, or there are too few limits to bound both sides.
///
/// The logarithm of width·height is strictly concave, so there is one such shape, and it either
/// touches one limit where the hyperbola width·height = const does (a·width = b·height), or lies in
/// the corner of two limits.
RectangleShape largest_shape(std::span<const RectangleLimit> limits);

}  // namespace biotomy::reconstruct
