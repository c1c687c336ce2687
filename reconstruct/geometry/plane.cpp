#include "reconstruct/geometry/plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

// A direction is told from an axis, and a triangle from a line, by these relative differences. They
// are far above rounding errors and far below anything a sample could show: 10⁻¹¹ of the diagonal
// of a block of 20 000 voxels is less than a millionth of a voxel.
constexpr double kNegligibleComponent = 1e-11;
constexpr double kFlatTriangle = 1e-9;
constexpr double kCoordinateRounding = 1e-12;
constexpr double kLengthRounding = 1e-15;  // of a vector that was divided by its length

double largest_component(const Vector3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

bool is_finite(const Vector3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Vector3 without_rounding(const Vector3& v) {
  const double negligible = kNegligibleComponent * largest_component(v);
  const auto kept = [&](double component) {
    return std::abs(component) < negligible ? 0.0 : component;
  };
  return {kept(v.x), kept(v.y), kept(v.z)};
}

// Scaled by its largest component first, so that no length overflows or vanishes.
Vector3 unit_normal(const Vector3& v) {
  const double largest = largest_component(v);
  const Vector3 scaled = without_rounding({v.x / largest, v.y / largest, v.z / largest});
  const double length = norm(scaled);
  return {scaled.x / length, scaled.y / length, scaled.z / length};
}

}  // namespace

Plane Plane::through_points(const Vector3& a, const Vector3& b, const Vector3& c) {
  if (!is_finite(a) || !is_finite(b) || !is_finite(c)) {
    throw InvalidRequest("a point of the plane is not a finite number: give three points x,y,z");
  }
  std::array<Vector3, 3> points{a, b, c};
  std::sort(points.begin(), points.end(), [](const Vector3& left, const Vector3& right) {
    return std::tie(left.x, left.y, left.z) < std::tie(right.x, right.y, right.z);
  });
  const double longest =
      std::max({largest_component(points[1] - points[0]), largest_component(points[2] - points[0]),
                largest_component(points[2] - points[1])});
  const double magnitude = std::max(largest_component(points[0]), largest_component(points[2]));
  if (!std::isfinite(longest)) {
    throw InvalidRequest("the three points of the plane are too far apart: check their unit");
  }
  if (longest <= kCoordinateRounding * magnitude) {
    throw InvalidRequest("the three points of the plane are one point: give three different ones");
  }
  const Vector3 first = (1.0 / longest) * (points[1] - points[0]);
  const Vector3 second = (1.0 / longest) * (points[2] - points[0]);
  const Vector3 normal = cross(first, second);
  if (norm(normal) <= kFlatTriangle + kCoordinateRounding * magnitude / longest) {
    throw InvalidRequest(
        "the three points of the plane lie on one line: move one of them off the line");
  }
  return from_normal(normal, points[0]);
}

Plane Plane::from_normal(const Vector3& normal, const Vector3& point) {
  if (!is_finite(normal) || normal == Vector3{}) {
    throw InvalidRequest("the normal of the plane must be a direction: not 0,0,0 and finite");
  }
  if (!is_finite(point)) {
    throw InvalidRequest("the point the plane goes through must be finite numbers");
  }
  const Vector3 unit = unit_normal(normal);
  return {unit, -dot(unit, point)};
}

Plane Plane::from_equation(double a, double b, double c, double d) {
  const Vector3 normal{a, b, c};
  if (!is_finite(normal) || normal == Vector3{} || !std::isfinite(d)) {
    throw InvalidRequest("a plane Ax+By+Cz+D=0 needs finite A, B, C, D and one of A, B, C not 0");
  }
  if (std::abs(norm(normal) - 1.0) <= kLengthRounding) {
    return {without_rounding(normal), d};  // dividing once more would change the last bits
  }
  const double largest = largest_component(normal);
  const double length = norm((1.0 / largest) * normal);
  return {unit_normal(normal), d / largest / length};
}

}  // namespace biotomy::reconstruct
