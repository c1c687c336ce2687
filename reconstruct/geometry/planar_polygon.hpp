#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace biotomy::reconstruct {

/// A point of a section plane, by its coordinates along two axes at right angles, micrometres.
struct PlanarPoint {
  double x = 0.0;
  double y = 0.0;
};

/// The points with a·x + b·y ≤ c, where (a, b) has length 1 and points out of the half-plane.
struct HalfPlane {
  double a = 0.0;
  double b = 0.0;
  double c = 0.0;

  /// Above 0 outside, in micrometres.
  double signed_distance(const PlanarPoint& point) const { return a * point.x + b * point.y - c; }
};

/// The same half-planes in axes that are turned by `angle` radians, from x towards y.
std::vector<HalfPlane> turned(std::span<const HalfPlane> sides, double angle);

/// A convex polygon of the section plane and the half-planes whose intersection it is. The vertices
/// go round it one way or the other; the first one should lie at (0, 0) or near, because rounding
/// errors grow with the coordinates.
class PlanarPolygon {
 public:
  /// Throws SampleError when the polygon is so thin (10⁻¹² of its diameter) that it is a line.
  explicit PlanarPolygon(std::span<const PlanarPoint> vertices);

  /// As they were given.
  const std::vector<PlanarPoint>& vertices() const { return vertices_; }

  /// One for each edge, anticlockwise. A vertex that stands out from the line between its
  /// neighbours by less than 10⁻¹³ of the diameter makes no two sides of one: the direction of an
  /// edge as short as that is mere rounding.
  const std::vector<HalfPlane>& sides() const { return sides_; }

  /// The greatest distance of two vertices, micrometres.
  double diameter() const { return diameter_; }

  /// The angle in radians from the x axis to edge `edge`, which goes from vertex `edge` to the
  /// next one, or the other way if that has the polygon on its left.
  double edge_angle(std::size_t edge) const;

 private:
  std::vector<PlanarPoint> vertices_;
  std::vector<HalfPlane> sides_;
  double diameter_ = 0.0;
  bool anticlockwise_ = true;
};

/// Throws the SampleError that says so.
[[noreturn]] void refuse_thin_polygon();

}  // namespace biotomy::reconstruct
