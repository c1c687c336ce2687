#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "reconstruct/geometry/planar_polygon.hpp"
#include "reconstruct/geometry/rectangle_limits.hpp"

namespace biotomy::reconstruct {

/// A triangle or a strip that holds a polygon and is bounded by lines of its sides.
///
/// The places where a rectangle of given shape and angle can lie within one side of the polygon are
/// a half-plane; half-planes have a point in common if every three of them have (Helly). So the
/// rectangle, moved but not turned, fits into the polygon exactly if it fits into every triangle
/// and strip that sides make round it; others are open and hold any rectangle. Two opposite sides
/// make a strip; three make a triangle if weights ≥ 0 exist with Σ weight·(a, b) = 0, and the
/// rectangle fits in if Σ weight·support ≤ Σ weight·c, its support being its extent along the
/// normal (a, b): max(a, 0)·width + max(b, 0)·height. The weights and Σ weight·c do not change when
/// the axes turn.
struct Enclosure {
  std::array<std::size_t, 3> sides{};  ///< indices; in a strip the third has the weight 0
  std::array<double, 3> weights{};
  double c = 0.0;  ///< Σ weight·c
};

/// At most 8 of six sides.
std::vector<Enclosure> enclosures(std::span<const HalfPlane> sides);

/// What each of them leaves to a rectangle along the axes of `sides`.
std::vector<RectangleLimit> limits_of(std::span<const Enclosure> enclosures,
                                      std::span<const HalfPlane> sides);

}  // namespace biotomy::reconstruct
