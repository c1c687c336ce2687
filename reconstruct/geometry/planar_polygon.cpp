#include "reconstruct/geometry/planar_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "reconstruct/errors.hpp"
#include "reconstruct/geometry/exact_cross.hpp"

namespace biotomy::reconstruct {
namespace {

// Both of the diameter.
constexpr double kFlatCorner = 1e-13;
constexpr double kThinPolygon = 1e-12;

double distance(const PlanarPoint& a, const PlanarPoint& b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

// Twice the area of the triangle, above 0 when it turns to the left.
double turn(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& c) {
  return exact_cross(b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
}

double greatest_distance(const std::vector<PlanarPoint>& vertices) {
  double greatest = 0.0;
  for (const PlanarPoint& a : vertices) {
    for (const PlanarPoint& b : vertices) {
      greatest = std::max(greatest, distance(a, b));
    }
  }
  return greatest;
}

double twice_the_area(const std::vector<PlanarPoint>& vertices) {
  double sum = 0.0;
  for (std::size_t i = 2; i < vertices.size(); ++i) {
    sum += turn(vertices[0], vertices[i - 1], vertices[i]);
  }
  return sum;
}

bool stands_out(const PlanarPoint& before, const PlanarPoint& point, const PlanarPoint& after,
                double tolerance) {
  return distance(before, point) > tolerance &&
         turn(before, point, after) > tolerance * distance(before, after);
}

// Each removal can flatten or sharpen the corners beside it, so it begins anew after one.
std::vector<PlanarPoint> without_flat_corners(std::vector<PlanarPoint> corners, double tolerance) {
  for (std::size_t i = 0; i < corners.size() && corners.size() > 2;) {
    const PlanarPoint& before = corners[(i + corners.size() - 1) % corners.size()];
    const PlanarPoint& after = corners[(i + 1) % corners.size()];
    if (stands_out(before, corners[i], after, tolerance)) {
      ++i;
    } else {
      corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
      i = 0;
    }
  }
  return corners;
}

// The line is moved out to the farther of the two corners, so that rounding cuts off neither.
HalfPlane side_through(const PlanarPoint& from, const PlanarPoint& to) {
  const double length = distance(from, to);
  HalfPlane side{(to.y - from.y) / length, -(to.x - from.x) / length, 0.0};
  side.c = std::max(side.signed_distance(from), side.signed_distance(to));
  return side;
}

// The least, over the sides, of the distance of the corner that is farthest from the side.
double thickness(const std::vector<HalfPlane>& sides, const std::vector<PlanarPoint>& corners,
                 double diameter) {
  double least = diameter;
  for (const HalfPlane& side : sides) {
    double depth = 0.0;
    for (const PlanarPoint& corner : corners) {
      depth = std::max(depth, -side.signed_distance(corner));
    }
    least = std::min(least, depth);
  }
  return least;
}

}  // namespace

std::vector<HalfPlane> turned(std::span<const HalfPlane> sides, double angle) {
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  std::vector<HalfPlane> result;
  result.reserve(sides.size());
  for (const HalfPlane& side : sides) {
    result.push_back({side.a * cosine + side.b * sine, side.b * cosine - side.a * sine, side.c});
  }
  return result;
}

PlanarPolygon::PlanarPolygon(std::span<const PlanarPoint> vertices)
    : vertices_(vertices.begin(), vertices.end()),
      diameter_(greatest_distance(vertices_)),
      anticlockwise_(twice_the_area(vertices_) > 0.0) {
  std::vector<PlanarPoint> corners = vertices_;
  if (!anticlockwise_) {
    std::reverse(corners.begin(), corners.end());
  }
  corners = without_flat_corners(std::move(corners), kFlatCorner * diameter_);
  if (corners.size() >= 3) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      sides_.push_back(side_through(corners[i], corners[(i + 1) % corners.size()]));
    }
  }
  if (sides_.empty() || thickness(sides_, corners, diameter_) <= kThinPolygon * diameter_) {
    refuse_thin_polygon();
  }
}

double PlanarPolygon::edge_angle(std::size_t edge) const {
  PlanarPoint from = vertices_.at(edge);
  PlanarPoint to = vertices_[(edge + 1) % vertices_.size()];
  if (!anticlockwise_) {
    std::swap(from, to);
  }
  return std::atan2(to.y - from.y, to.x - from.x);
}

void refuse_thin_polygon() {
  throw SampleError(
      "the section is too thin to hold a rectangle: ask for the bounding one, or move the plane");
}

}  // namespace biotomy::reconstruct
