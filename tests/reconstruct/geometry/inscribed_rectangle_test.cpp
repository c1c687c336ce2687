#include "reconstruct/geometry/inscribed_rectangle.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/geometry/random_polygon.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr int kPolygons = 4000;  // the even ones are sections of cuboids
constexpr double kDegree = M_PI / 180.0;

using Points = std::vector<PlanarPoint>;

Points polygon_number(int i, std::mt19937& random) {
  return i % 2 == 0 ? tests::random_section(random) : tests::random_polygon(random);
}

Points turned_points(const Points& points, double angle) {
  Points result;
  for (const PlanarPoint& point : points) {
    result.push_back({point.x * std::cos(angle) + point.y * std::sin(angle),
                      point.y * std::cos(angle) - point.x * std::sin(angle)});
  }
  return result;
}

Points regular_polygon(int count, double first_angle) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const double angle = first_angle + 2.0 * M_PI * i / count;
    points.push_back({std::cos(angle), std::sin(angle)});
  }
  return points;
}

double area(const PlanarRectangle& rectangle) {
  return rectangle.width * rectangle.height;
}

// The polygon from the line at x downwards to upwards: what a vertical line has in common with it.
struct Chord {
  double bottom = std::numeric_limits<double>::infinity();
  double top = -std::numeric_limits<double>::infinity();
};

Chord chord_at(const Points& points, double x) {
  Chord chord;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PlanarPoint& a = points[i];
    const PlanarPoint& b = points[(i + 1) % points.size()];
    if (std::min(a.x, b.x) <= x && x <= std::max(a.x, b.x)) {
      const double part = a.x == b.x ? 0.0 : (x - a.x) / (b.x - a.x);
      for (const double y :
           {a.y + part * (b.y - a.y), a.x == b.x ? b.y : a.y + part * (b.y - a.y)}) {
        chord.bottom = std::min(chord.bottom, y);
        chord.top = std::max(chord.top, y);
      }
    }
  }
  return chord;
}

// The greatest value of a function with one peak, by its golden sections.
double greatest(double low, double high, int steps, const std::function<double(double)>& f) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double left = high - golden * (high - low);
  double right = low + golden * (high - low);
  double at_left = f(left);
  double at_right = f(right);
  for (int i = 0; i < steps; ++i) {
    if (at_left > at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - golden * (high - low);
      at_left = f(left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + golden * (high - low);
      at_right = f(right);
    }
  }
  return std::max(at_left, at_right);
}

// By the left and the right end of the rectangle: the area's logarithm is concave in them.
double brute_force_area(const Points& points) {
  constexpr int kSteps = 60;
  const auto ends =
      std::minmax_element(points.begin(), points.end(),
                          [](const PlanarPoint& a, const PlanarPoint& b) { return a.x < b.x; });
  return greatest(ends.first->x, ends.second->x, kSteps, [&](double left) {
    const Chord at_left = chord_at(points, left);
    return greatest(left, ends.second->x, kSteps, [&](double right) {
      const Chord at_right = chord_at(points, right);
      // Below 0 it still falls away from the peak.
      return (right - left) *
             (std::min(at_left.top, at_right.top) - std::max(at_left.bottom, at_right.bottom));
    });
  });
}

// Of all angles, by the function that is tested for each: the best of many, and what lies about it.
double brute_force_area_at_any_angle(const PlanarPolygon& polygon) {
  const auto area_at = [&](double angle) { return area(largest_rectangle(polygon, angle)); };
  constexpr double kStep = 0.5 * kDegree;
  constexpr int kFirst = -91;  // half a degree more than is needed
  std::vector<double> areas;
  for (int i = kFirst; i <= -kFirst; ++i) {
    areas.push_back(area_at(i * kStep));
  }
  double best = 0.0;
  for (std::size_t i = 1; i + 1 < areas.size(); ++i) {
    if (areas[i] >= areas[i - 1] && areas[i] >= areas[i + 1]) {
      const double middle = (kFirst + static_cast<double>(i)) * kStep;
      best = std::max(best, greatest(middle - kStep, middle + kStep, 40, area_at));
    }
  }
  return best;
}

void expect_inside(const PlanarRectangle& rectangle, const PlanarPolygon& polygon) {
  for (const HalfPlane& side : turned(polygon.sides(), rectangle.angle)) {
    for (const double x : {0.0, rectangle.width}) {
      for (const double y : {0.0, rectangle.height}) {
        EXPECT_LE(side.signed_distance({rectangle.corner.x + x, rectangle.corner.y + y}),
                  2e-14 * polygon.diameter());
      }
    }
  }
}

bool has_a_side_on(const PlanarRectangle& rectangle, const PlanarPoint& from, const PlanarPoint& to,
                   double tolerance) {
  const Points ends = turned_points({from, to}, rectangle.angle);
  const auto along = [&](double a, double b, double line) {
    return std::abs(a - line) <= tolerance && std::abs(b - line) <= tolerance;
  };
  return along(ends[0].x, ends[1].x, rectangle.corner.x) ||
         along(ends[0].x, ends[1].x, rectangle.corner.x + rectangle.width) ||
         along(ends[0].y, ends[1].y, rectangle.corner.y) ||
         along(ends[0].y, ends[1].y, rectangle.corner.y + rectangle.height);
}

// With its base on the x axis, by the height: the base is as long as the shorter of the edge and
// what is above both.
double brute_force_area_on_base(const Points& points, double edge_first, double edge_last) {
  Points sideways;
  double highest = 0.0;
  for (const PlanarPoint& point : points) {
    sideways.push_back({point.y, point.x});
    highest = std::max(highest, point.y);
  }
  return greatest(0.0, highest, 90, [&](double height) {
    const Chord above = chord_at(sideways, height);
    return height * (std::min(above.top, edge_last) - std::max(above.bottom, edge_first));
  });
}

TEST(LargestRectangle, IsAsLargeAsBruteForceFindsItAndInsideThePolygon) {
  std::mt19937 random(11);
  for (int i = 0; i < kPolygons; ++i) {
    const Points points = polygon_number(i, random);
    const PlanarPolygon polygon(points);
    const double angle = 0.3 * (i % 3);
    const PlanarRectangle rectangle = largest_rectangle(polygon, angle);
    const double expected = brute_force_area(turned_points(points, angle));
    ASSERT_NEAR(area(rectangle), expected, 1e-9 * expected) << i;
    EXPECT_EQ(rectangle.angle, angle);
    expect_inside(rectangle, polygon);
  }
}

TEST(LargestRectangleOnEdge, IsAsLargeAsBruteForceFindsItAndLiesOnTheEdge) {
  std::mt19937 random(12);
  for (int i = 0; i < kPolygons; ++i) {
    const Points points = polygon_number(i, random);
    const PlanarPolygon polygon(points);
    const std::size_t edge = random() % points.size();
    const PlanarPoint& from = points[edge];
    const PlanarPoint& to = points[(edge + 1) % points.size()];
    const PlanarRectangle rectangle = largest_rectangle_on_edge(polygon, edge);

    const double slope = std::atan2(to.y - from.y, to.x - from.x);
    Points seen;
    double side = 0.0;
    for (const PlanarPoint& point : points) {
      seen.push_back({point.x - from.x, point.y - from.y});
    }
    seen = turned_points(seen, slope);
    for (PlanarPoint& point : seen) {
      side += point.y;
    }
    for (PlanarPoint& point : seen) {
      point.y = side < 0.0 ? -point.y : point.y;
    }
    seen[edge].y = 0.0;
    seen[(edge + 1) % seen.size()].y = 0.0;
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    const double expected = brute_force_area_on_base(seen, 0.0, length);

    ASSERT_NEAR(area(rectangle), expected, 1e-9 * expected) << i;
    EXPECT_GT(rectangle.angle, -45.0 * kDegree);
    EXPECT_LE(rectangle.angle, 45.0 * kDegree);
    EXPECT_TRUE(has_a_side_on(rectangle, from, to, 1e-13 * polygon.diameter())) << i;
    expect_inside(rectangle, polygon);
  }
}

TEST(LargestRectangleAtAnyAngle, IsAsLargeAsBruteForceFindsItAndInsideThePolygon) {
  std::mt19937 random(13);
  int met = 0;
  for (int i = 0; i < kPolygons; ++i) {
    const PlanarPolygon polygon(polygon_number(i, random));
    const PlanarRectangle rectangle = largest_rectangle_at_any_angle(polygon);
    const double expected = brute_force_area_at_any_angle(polygon);
    ASSERT_GE(area(rectangle), expected * (1.0 - 1e-9)) << i;
    met += area(rectangle) <= expected * (1.0 + 1e-6) ? 1 : 0;
    EXPECT_GT(rectangle.angle, -45.0 * kDegree);
    EXPECT_LE(rectangle.angle, 45.0 * kDegree);
    expect_inside(rectangle, polygon);
  }
  // Brute force passes by peaks that are narrower than its steps, so not all.
  EXPECT_GT(met, 0.98 * kPolygons);
}

// Equilateral, of side √3: half the triangle (√3·3/2/2 / 2), on any of its sides.
TEST(LargestRectangle, OfAnEquilateralTriangleIsHalfOfIt) {
  const PlanarPolygon triangle(regular_polygon(3, 90.0 * kDegree));
  const double half = 3.0 * std::sqrt(3.0) / 8.0;
  const PlanarRectangle along = largest_rectangle(triangle, 0.0);
  EXPECT_NEAR(along.width, std::sqrt(3.0) / 2.0, 1e-14);
  EXPECT_NEAR(along.height, 0.75, 1e-14);
  EXPECT_NEAR(along.corner.x, -std::sqrt(3.0) / 4.0, 1e-13);
  EXPECT_NEAR(along.corner.y, -0.5, 1e-13);
  EXPECT_NEAR(area(largest_rectangle_at_any_angle(triangle)), half, 1e-14);
  for (std::size_t edge = 0; edge < 3; ++edge) {
    EXPECT_NEAR(area(largest_rectangle_on_edge(triangle, edge)), half, 1e-14);
  }
}

TEST(LargestRectangle, OfASquareAtACornerIsHalfOfIt) {
  const PlanarPolygon square(regular_polygon(4, 0.0));
  const PlanarRectangle rectangle = largest_rectangle(square, 0.0);
  EXPECT_NEAR(rectangle.width, 1.0, 1e-14);
  EXPECT_NEAR(rectangle.height, 1.0, 1e-14);
  EXPECT_NEAR(rectangle.corner.x, -0.5, 1e-13);
  EXPECT_NEAR(rectangle.corner.y, -0.5, 1e-13);
}

TEST(LargestRectangle, OfARectangleIsThatRectangleToTheLastBit) {
  const PlanarPolygon polygon(Points{{0, 0}, {0.1, 0}, {0.1, 0.7}, {0, 0.7}});
  for (const PlanarRectangle& rectangle :
       {largest_rectangle(polygon, 0.0), largest_rectangle_at_any_angle(polygon)}) {
    EXPECT_EQ(rectangle.angle, 0.0);
    EXPECT_EQ(rectangle.corner.x, 0.0);
    EXPECT_EQ(rectangle.corner.y, 0.0);
    EXPECT_EQ(rectangle.width, 0.1);
    EXPECT_EQ(rectangle.height, 0.7);
  }
}

// Of circumradius 1, a vertex at the right and one at the left. With the height 2y, y ≤ √3/2, the
// width is 2 − 2y/√3; 4y·(1 − y/√3) grows up to y = √3/2.
TEST(LargestRectangle, OfARegularHexagonHasTwoOfItsSidesWhole) {
  const PlanarPolygon hexagon(regular_polygon(6, 0.0));
  for (const PlanarRectangle& rectangle :
       {largest_rectangle(hexagon, 0.0), largest_rectangle_at_any_angle(hexagon),
        largest_rectangle_on_edge(hexagon, 1), largest_rectangle_on_edge(hexagon, 4)}) {
    EXPECT_NEAR(rectangle.angle, 0.0, 1e-15);
    EXPECT_NEAR(rectangle.width, 1.0, 1e-14);
    EXPECT_NEAR(rectangle.height, std::sqrt(3.0), 1e-14);
    EXPECT_NEAR(rectangle.corner.x, -0.5, 1e-13);
    EXPECT_NEAR(rectangle.corner.y, -std::sqrt(3.0) / 2.0, 1e-13);
  }
}

TEST(LargestRectangle, IsInTheMiddleOfWhereItCanBeMovedTo) {
  const PlanarPolygon parallelogram(Points{{0, 0}, {10, 0}, {12, 1}, {2, 1}});
  const PlanarRectangle whole = largest_rectangle(parallelogram, 0.0);
  EXPECT_NEAR(whole.corner.x, 2.0, 1e-12);
  EXPECT_NEAR(whole.width, 8.0, 1e-13);
  // Along a strip that ends in points: at 45 degrees it could be anywhere along the straight part.
  const PlanarPolygon pencil(Points{{0, 0}, {1, -1}, {21, -1}, {22, 0}, {21, 1}, {1, 1}});
  const PlanarRectangle middle = largest_rectangle(pencil, 45.0 * kDegree);
  const double x = middle.corner.x + 0.5 * middle.width;
  const double y = middle.corner.y + 0.5 * middle.height;
  EXPECT_NEAR(x * std::cos(0.25 * M_PI) - y * std::sin(0.25 * M_PI), 11.0, 1e-11);
  EXPECT_NEAR(x * std::sin(0.25 * M_PI) + y * std::cos(0.25 * M_PI), 0.0, 1e-11);
}

TEST(LargestRectangleAtAnyAngle, OfASquareIsTheSquare) {
  for (const double degrees : {-44.0, -10.0, 0.0, 30.0, 45.0}) {
    const PlanarPolygon square(regular_polygon(4, (45.0 + degrees) * kDegree));
    const PlanarRectangle rectangle = largest_rectangle_at_any_angle(square);
    EXPECT_NEAR(rectangle.angle, degrees * kDegree, 1e-14);
    EXPECT_NEAR(rectangle.width, std::sqrt(2.0), 1e-14);
    EXPECT_NEAR(rectangle.height, std::sqrt(2.0), 1e-14);
  }
}

TEST(LargestRectangleAtAnyAngle, IsTurnedTheLeastAmongEqualOnes) {
  // The equilateral triangle has three; they are 60 degrees, thus also 30 degrees apart.
  for (const double degrees : {0.0, 14.0, -14.0}) {
    const PlanarPolygon triangle(regular_polygon(3, (90.0 + degrees) * kDegree));
    EXPECT_NEAR(largest_rectangle_at_any_angle(triangle).angle, degrees * kDegree, 1e-14);
  }
  const PlanarPolygon both_sides(regular_polygon(3, (90.0 + 15.0) * kDegree));
  EXPECT_NEAR(largest_rectangle_at_any_angle(both_sides).angle, 15.0 * kDegree, 1e-14);
}

// In mirror images the limits of two enclosures coincide at the axis of the mirror, and no side of
// the polygon lies along it.
TEST(LargestRectangleAtAnyAngle, OfAKiteIsAsLargeAsBruteForceFindsIt) {
  for (const double tail : {1.0, 1.2, 1.5, 2.0, 3.0, 5.0, 9.0}) {
    const PlanarPolygon kite(Points{{0, 0}, {1, -1}, {1 + tail, 0}, {1, 1}});
    const double expected = brute_force_area_at_any_angle(kite);
    EXPECT_NEAR(area(largest_rectangle_at_any_angle(kite)), expected, 1e-9 * expected) << tail;
  }
}

TEST(LargestRectangle, GrowsWithThePolygonFromMicrometresToMetres) {
  std::mt19937 random(17);
  for (int i = 0; i < 300; ++i) {
    const Points points = polygon_number(i, random);
    const PlanarRectangle one = largest_rectangle_at_any_angle(PlanarPolygon(points));
    for (const double factor : {1e-6, 1e-3, 1e6}) {
      Points scaled;
      for (const PlanarPoint& point : points) {
        scaled.push_back({factor * point.x, factor * point.y});
      }
      const PlanarRectangle other = largest_rectangle_at_any_angle(PlanarPolygon(scaled));
      EXPECT_NEAR(area(other), factor * factor * area(one), 1e-9 * factor * factor * area(one));
    }
  }
}

Points thin_triangle(double height) {
  return {{0, 0}, {600, 100}, {300 - height, 50 + 6 * height}};
}

TEST(LargestRectangle, OfAThinTriangleIsHalfOfIt) {
  for (const double height : {1e-2, 1e-5, 1e-8, 1e-9}) {
    const PlanarPolygon triangle(thin_triangle(height));
    const double expected = 925.0 * height;
    const double rounding = 1e-9 + 1e-13 / height;  // of the vertices' coordinates
    const PlanarRectangle rectangle = largest_rectangle_at_any_angle(triangle);
    EXPECT_NEAR(area(rectangle), expected, rounding * expected) << height;
    expect_inside(rectangle, triangle);
    for (const PlanarRectangle& other :
         {largest_rectangle(triangle, 0.0), largest_rectangle_on_edge(triangle, 2)}) {
      EXPECT_GT(area(other), 0.0);
      expect_inside(other, triangle);
    }
  }
}

TEST(LargestRectangle, OfALineIsRefused) {
  for (const double height : {1e-11, 1e-15, 0.0}) {
    try {
      PlanarPolygon line(thin_triangle(height));
      FAIL() << "no error";
    } catch (const SampleError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("too thin to hold a rectangle"));
    }
  }
}

// The side across from edge 1 is as good as parallel to it; the rounding error of the height, times
// the inverse of their slope, is longer than the edge.
TEST(LargestRectangleOnEdge, StaysInsideAPolygonThatIsAMillionTimesLongerThanTheEdge) {
  const PlanarPolygon polygon(Points{{0, 0},
                                     {8493403392.2610321, 0},
                                     {8493403392.2611275, 3461.8324250600454},
                                     {0.0001151175398422382, 4202.1076907882234}});
  const PlanarRectangle rectangle = largest_rectangle_on_edge(polygon, 1);
  EXPECT_NEAR(rectangle.height, 3461.8324250600454, 1e-3);
  expect_inside(rectangle, polygon);
}

TEST(LargestRectangle, TakesVerticesThatAreRoundingErrorsForNone) {
  const Points noisy{{0, 0}, {1e-14, -1e-15}, {50, -1e-14}, {100, 0}, {100, 60}, {0, 60 + 1e-13}};
  const PlanarRectangle rectangle = largest_rectangle_at_any_angle(PlanarPolygon(noisy));
  EXPECT_NEAR(area(rectangle), 6000.0, 1e-9);
  EXPECT_NEAR(rectangle.angle, 0.0, 1e-12);
}

}  // namespace
}  // namespace biotomy::reconstruct
