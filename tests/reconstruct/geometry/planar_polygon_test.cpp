#include "reconstruct/geometry/planar_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/geometry/exact_cross.hpp"
#include "tests/reconstruct/geometry/random_polygon.hpp"

namespace biotomy::reconstruct {
namespace {

using Points = std::vector<PlanarPoint>;

const Points kRectangle{{0, 0}, {4, 0}, {4, 3}, {0, 3}};

TEST(ExactCross, IsRightWhereTheProductsNearlyCancel) {
  const double a = 1.0 + 0x1p-30;
  const double b = 1.0 - 0x1p-30;
  EXPECT_EQ(exact_cross(a, 1.0, 1.0, b), -0x1p-60);
  EXPECT_EQ(a * b - 1.0, 0.0);  // what it would be without care
}

TEST(PlanarPolygon, HasASideForEachEdgeWhicheverWayItsVerticesGo) {
  Points backwards = kRectangle;
  std::reverse(backwards.begin(), backwards.end());
  for (const Points& points : {kRectangle, backwards}) {
    const PlanarPolygon polygon(points);
    EXPECT_EQ(polygon.sides().size(), 4U);
    EXPECT_DOUBLE_EQ(polygon.diameter(), 5.0);
    for (const HalfPlane& side : polygon.sides()) {
      EXPECT_LT(side.signed_distance({2.0, 1.5}), -1.0);
      EXPECT_DOUBLE_EQ(std::hypot(side.a, side.b), 1.0);
    }
  }
}

TEST(PlanarPolygon, HasAllItsVerticesInItsSides) {
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    const PlanarPolygon polygon(i % 2 == 0 ? tests::random_section(random)
                                           : tests::random_polygon(random));
    EXPECT_EQ(polygon.sides().size(), polygon.vertices().size());
    for (const HalfPlane& side : polygon.sides()) {
      for (const PlanarPoint& vertex : polygon.vertices()) {
        EXPECT_LE(side.signed_distance(vertex), 1e-15 * polygon.diameter());
      }
    }
  }
}

TEST(PlanarPolygon, TurnedSidesAreThoseOfTheTurnedVertices) {
  const PlanarPolygon polygon(kRectangle);
  const double angle = 0.7;
  for (const HalfPlane& side : turned(polygon.sides(), angle)) {
    int on_the_line = 0;
    for (const PlanarPoint& vertex : kRectangle) {
      const double distance =
          side.signed_distance({vertex.x * std::cos(angle) + vertex.y * std::sin(angle),
                                vertex.y * std::cos(angle) - vertex.x * std::sin(angle)});
      on_the_line += std::abs(distance) < 1e-14 ? 1 : 0;
    }
    EXPECT_EQ(on_the_line, 2);
  }
}

TEST(PlanarPolygon, EdgesHaveThePolygonOnTheirLeft) {
  EXPECT_DOUBLE_EQ(PlanarPolygon(kRectangle).edge_angle(1), 0.5 * M_PI);
  EXPECT_DOUBLE_EQ(PlanarPolygon(Points{{0, 0}, {0, 3}, {4, 3}, {4, 0}}).edge_angle(0),
                   -0.5 * M_PI);
}

TEST(PlanarPolygon, WithoutAreaIsRefused) {
  EXPECT_THROW(PlanarPolygon(Points{{0, 0}, {1, 1}, {2, 2}}), SampleError);
  EXPECT_THROW(PlanarPolygon(Points{{0, 0}, {0, 0}, {0, 0}}), SampleError);
}

TEST(PlanarPolygon, HasNoSideForAnEdgeThatIsOnlyRounding) {
  const PlanarPolygon polygon(Points{{0, 0}, {4, 0}, {4, 1e-15}, {4, 3}, {2, 3 - 1e-14}, {0, 3}});
  EXPECT_EQ(polygon.sides().size(), 4U);
}

}  // namespace
}  // namespace biotomy::reconstruct
