#pragma once

#include "reconstruct/geometry/vector3.hpp"

namespace biotomy::reconstruct {

/// A plane of the sample frame: the points x with normal·x + offset = 0, the normal of length 1 and
/// the offset in micrometres (Ax + By + Cz + D = 0, divided by the length of (A, B, C)).
/// Components of the normal below 10⁻¹¹ are taken for rounding errors and are zero, so that a plane
/// meant to lie along an axis does. All functions that make one throw InvalidRequest where there is
/// no such plane.
class Plane {
 public:
  /// Through three points in micrometres, in any order: the order makes no difference, not even of
  /// rounding. Refuses points that lie on one line (or are one point).
  static Plane through_points(const Vector3& a, const Vector3& b, const Vector3& c);

  /// Through a point in micrometres; the normal may have any length above zero and keeps its sign.
  static Plane from_normal(const Vector3& normal, const Vector3& point);

  /// a·x + b·y + c·z + d = 0 with x, y, z in micrometres. A plane's own normal and offset make that
  /// plane again, to the bit.
  static Plane from_equation(double a, double b, double c, double d);

  const Vector3& normal() const { return normal_; }
  double offset() const { return offset_; }

  /// In micrometres, positive on the side the normal points to.
  double signed_distance(const Vector3& point) const { return dot(normal_, point) + offset_; }

 private:
  Plane(const Vector3& unit_normal, double offset) : normal_(unit_normal), offset_(offset) {}

  Vector3 normal_;
  double offset_;
};

}  // namespace biotomy::reconstruct
