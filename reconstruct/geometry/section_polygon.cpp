#include "reconstruct/geometry/section_polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

// Of the box's diagonal. What is taken for on the plane is put into the picture as it is, so that
// the first may be no more than rounding; the second only spares vertices.
constexpr double kOnPlane = 1e-13;
constexpr double kSamePoint = 1e-11;

// Corner number: bit 0 is set at the far end along x, bit 1 along y, bit 2 along z.
constexpr std::size_t kCorners = 8;

std::array<Vector3, kCorners> corners_of(const Cuboid& cuboid) {
  const Vector3 far = cuboid.extent();
  std::array<Vector3, kCorners> corners;
  for (std::size_t i = 0; i < kCorners; ++i) {
    corners[i] = {(i & 1U) != 0 ? far.x : 0.0, (i & 2U) != 0 ? far.y : 0.0,
                  (i & 4U) != 0 ? far.z : 0.0};
  }
  return corners;
}

// The end `a` is at the lesser coordinate of the edge, so that an edge gives the same point
// whatever the sign of the normal; coordinates that the edge does not change stay exact.
Vector3 crossing(const Vector3& a, double distance_a, const Vector3& b, double distance_b) {
  const double part = distance_a / (distance_a - distance_b);
  return a + part * (b - a);
}

void add_unless_there(std::vector<Vector3>& points, const Vector3& point, double tolerance) {
  const bool there = std::any_of(points.begin(), points.end(), [&](const Vector3& other) {
    return norm(point - other) <= tolerance;
  });
  if (!there) {
    points.push_back(point);
  }
}

bool precedes(const Vector3& a, const Vector3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

// Of a normal and its opposite, the one whose first component that is not zero is positive.
Vector3 without_sign(const Vector3& normal) {
  return precedes(normal, Vector3{}) ? -1.0 * normal : normal;
}

void order_around_centre(std::vector<Vector3>& points, const Vector3& normal) {
  std::swap(points.front(), *std::min_element(points.begin(), points.end(), precedes));
  Vector3 centre;
  for (const Vector3& point : points) {
    centre = centre + (1.0 / static_cast<double>(points.size())) * point;
  }
  const Vector3 zero = points.front() - centre;
  const Vector3 quarter = cross(without_sign(normal), zero);
  const auto angle = [&](const Vector3& point) {
    const double around = std::atan2(dot(point - centre, quarter), dot(point - centre, zero));
    return around < 0.0 ? around + 2.0 * M_PI : around;
  };
  std::sort(points.begin() + 1, points.end(),
            [&](const Vector3& a, const Vector3& b) { return angle(a) < angle(b); });
}

std::string describe(const Vector3& point) {
  std::ostringstream text;
  text << point.x << ',' << point.y << ',' << point.z;
  return text.str();
}

}  // namespace

PlaneContact contact(const Plane& plane, const Cuboid& cuboid) {
  const std::array<Vector3, kCorners> corners = corners_of(cuboid);
  const double on_plane = kOnPlane * norm(cuboid.extent());
  const double tolerance = kSamePoint * norm(cuboid.extent());

  std::array<double, kCorners> distances{};
  double nearest = std::numeric_limits<double>::infinity();
  PlaneContact result;
  for (std::size_t i = 0; i < kCorners; ++i) {
    distances[i] = plane.signed_distance(corners[i]);
    nearest = std::min(nearest, std::abs(distances[i]));
    if (std::abs(distances[i]) <= on_plane) {
      distances[i] = 0.0;
      add_unless_there(result.vertices, corners[i], tolerance);
    }
  }
  for (std::size_t i = 0; i < kCorners; ++i) {
    for (const std::size_t axis : {1U, 2U, 4U}) {
      const std::size_t j = i | axis;
      if (i != j && distances[i] * distances[j] < 0.0) {
        add_unless_there(result.vertices,
                         crossing(corners[i], distances[i], corners[j], distances[j]), tolerance);
      }
    }
  }
  if (result.vertices.empty()) {
    result.distance = nearest;
  } else if (result.vertices.size() >= 3) {
    order_around_centre(result.vertices, plane.normal());
  }
  return result;
}

std::vector<Vector3> section_polygon(const Plane& plane, const Cuboid& cuboid) {
  PlaneContact found = contact(plane, cuboid);
  if (found.vertices.size() >= 3) {
    return std::move(found.vertices);
  }
  std::ostringstream message;
  if (found.vertices.empty()) {
    message << "the plane misses the sample by " << found.distance
            << " um: it reaches from 0,0,0 to " << describe(cuboid.extent()) << " um";
  } else if (found.vertices.size() == 1) {
    message << "the plane touches the sample only at the vertex " << describe(found.vertices[0])
            << " um: move it into the sample";
  } else {
    message << "the plane touches the sample only along the edge from "
            << describe(found.vertices[0]) << " to " << describe(found.vertices[1])
            << " um: move it into the sample";
  }
  throw SampleError(message.str());
}

}  // namespace biotomy::reconstruct
