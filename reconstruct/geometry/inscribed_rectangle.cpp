#include "reconstruct/geometry/inscribed_rectangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "reconstruct/geometry/enclosure.hpp"
#include "reconstruct/geometry/exact_cross.hpp"

namespace biotomy::reconstruct {
namespace {

// Of the diameter: how far a rectangle may reach over a side.
constexpr double kRounding = 1e-14;
constexpr double kMostRounding = 1e-11;

constexpr double kHorizontal = 1e-11;  // of the sine between an edge and a side

constexpr double kQuarterTurn = M_PI / 2.0;
constexpr double kEighthTurn = M_PI / 4.0;

// The half-planes in which the first corner of a rectangle of this shape must lie.
std::vector<HalfPlane> made_narrower(std::vector<HalfPlane> sides, const RectangleShape& shape) {
  for (HalfPlane& side : sides) {
    side.c -= std::max(side.a, 0.0) * shape.width + std::max(side.b, 0.0) * shape.height;
  }
  return sides;
}

bool inside(const PlanarPoint& point, const std::vector<HalfPlane>& sides, double tolerance) {
  return std::all_of(sides.begin(), sides.end(), [&](const HalfPlane& side) {
    return side.signed_distance(point) <= tolerance;
  });
}

PlanarRectangle bounding_rectangle(const PlanarPolygon& polygon, double angle) {
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  PlanarPoint least{std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
  PlanarPoint most{-least.x, -least.y};
  for (const PlanarPoint& vertex : polygon.vertices()) {
    const double x = vertex.x * cosine + vertex.y * sine;
    const double y = vertex.y * cosine - vertex.x * sine;
    least = {std::min(least.x, x), std::min(least.y, y)};
    most = {std::max(most.x, x), std::max(most.y, y)};
  }
  return {angle, least, most.x - least.x, most.y - least.y};
}

// All places where the corner can be make a point, a stretch or, of rounding, a sliver. Its ends
// are crossings of its bounds; the two farthest from each other have its middle between them.
std::optional<PlanarPoint> middle_of(const std::vector<HalfPlane>& bounds, double tolerance) {
  std::vector<PlanarPoint> ends;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const HalfPlane& f = bounds[i];
      const HalfPlane& g = bounds[k];
      const double determinant = exact_cross(f.a, f.b, g.a, g.b);
      const PlanarPoint crossing{exact_cross(f.c, f.b, g.c, g.b) / determinant,
                                 exact_cross(f.a, f.c, g.a, g.c) / determinant};
      if (determinant != 0.0 && inside(crossing, bounds, tolerance)) {
        ends.push_back(crossing);
      }
    }
  }
  std::optional<PlanarPoint> middle;
  double longest = -1.0;
  for (const PlanarPoint& a : ends) {
    for (const PlanarPoint& b : ends) {
      const double length = std::hypot(b.x - a.x, b.y - a.y);
      if (length > longest) {
        longest = length;
        middle = {0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
      }
    }
  }
  return middle;
}

// What `find` finds with the least tolerance, micrometres, that lets it find anything.
template <typename Find>
auto within_rounding(double diameter, const Find& find) {
  for (double tolerance = kRounding; tolerance <= kMostRounding; tolerance *= 10.0) {
    if (const auto found = find(tolerance * diameter)) {
      return *found;
    }
  }
  refuse_thin_polygon();
}

// What sides leave to a rectangle whose first corner is on the x axis: a side that leans to the
// right and one that leans to the left make a triangle or a trapezium with the axis; a side along
// the axis bounds the height.
std::vector<RectangleLimit> limits_on_axis(const std::vector<HalfPlane>& sides) {
  std::vector<RectangleLimit> limits;
  for (const HalfPlane& right : sides) {
    if (std::abs(right.a) <= kHorizontal) {
      if (right.b > 0.0) {
        limits.push_back({0.0, right.b, right.c});
      }
      continue;
    }
    for (const HalfPlane& left : sides) {
      if (right.a > 0.0 && left.a < -kHorizontal) {
        limits.push_back({-left.a * right.a,
                          -left.a * std::max(right.b, 0.0) + right.a * std::max(left.b, 0.0),
                          -left.a * right.c + right.a * left.c});
      }
    }
  }
  return limits;
}

// A side that is nearly along the axis turns the rounding error of the height into a long way on
// the axis: without tolerance it would push the rectangle out of the others.
std::optional<double> middle_on_axis(const std::vector<HalfPlane>& bounds, double tolerance) {
  double first = -std::numeric_limits<double>::infinity();
  double last = std::numeric_limits<double>::infinity();
  for (const HalfPlane& bound : bounds) {
    if (bound.a > kHorizontal) {
      last = std::min(last, (bound.c + tolerance) / bound.a);
    } else if (bound.a < -kHorizontal) {
      first = std::max(first, (bound.c + tolerance) / bound.a);
    }
  }
  return first <= last ? std::optional(0.5 * (first + last)) : std::nullopt;
}

// The same rectangle along axes turned back by 90°.
PlanarRectangle turned_back(const PlanarRectangle& rectangle) {
  return {rectangle.angle - kQuarterTurn,
          {-rectangle.corner.y - rectangle.height, rectangle.corner.x},
          rectangle.height,
          rectangle.width};
}

}  // namespace

PlanarRectangle largest_rectangle(const PlanarPolygon& polygon, double angle) {
  const std::vector<HalfPlane> sides = turned(polygon.sides(), angle);
  const PlanarRectangle bounding = bounding_rectangle(polygon, angle);
  if (inside(bounding.corner, made_narrower(sides, {bounding.width, bounding.height}),
             kRounding * polygon.diameter())) {
    return bounding;
  }
  const RectangleShape shape = largest_shape(limits_of(enclosures(sides), sides));
  if (shape.area() == 0.0) {
    refuse_thin_polygon();
  }
  const std::vector<HalfPlane> bounds = made_narrower(sides, shape);
  const PlanarPoint corner = within_rounding(
      polygon.diameter(), [&](double tolerance) { return middle_of(bounds, tolerance); });
  return {angle, corner, shape.width, shape.height};
}

PlanarRectangle largest_rectangle_on_edge(const PlanarPolygon& polygon, std::size_t edge) {
  const double angle = polygon.edge_angle(edge);
  const PlanarPoint& end = polygon.vertices().at(edge);
  const double height_of_edge = end.y * std::cos(angle) - end.x * std::sin(angle);
  std::vector<HalfPlane> sides = turned(polygon.sides(), angle);
  for (HalfPlane& side : sides) {
    side.c -= side.b * height_of_edge;
  }
  const RectangleShape shape = largest_shape(limits_on_axis(sides));
  if (shape.area() == 0.0) {
    refuse_thin_polygon();
  }
  const std::vector<HalfPlane> bounds = made_narrower(sides, shape);
  const double x = within_rounding(
      polygon.diameter(), [&](double tolerance) { return middle_on_axis(bounds, tolerance); });
  PlanarRectangle rectangle{angle, {x, height_of_edge}, shape.width, shape.height};
  if (rectangle.angle <= -kEighthTurn) {
    rectangle.angle += 2.0 * M_PI;
  }
  while (rectangle.angle > kEighthTurn) {
    rectangle = turned_back(rectangle);
  }
  return rectangle;
}

}  // namespace biotomy::reconstruct
