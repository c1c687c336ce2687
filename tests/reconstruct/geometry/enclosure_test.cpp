#include "reconstruct/geometry/enclosure.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/reconstruct/geometry/random_polygon.hpp"

namespace biotomy::reconstruct {
namespace {

using Points = std::vector<PlanarPoint>;

std::vector<RectangleLimit> limits_along_axes(const Points& points) {
  const PlanarPolygon polygon(points);
  return limits_of(enclosures(polygon.sides()), polygon.sides());
}

TEST(Enclosures, OfARectangleAreItsTwoStrips) {
  const auto limits = limits_along_axes({{0, 0}, {4, 0}, {4, 3}, {0, 3}});
  ASSERT_EQ(limits.size(), 2U);
  EXPECT_DOUBLE_EQ(limits[0].c / limits[0].b, 3.0);
  EXPECT_EQ(limits[0].a, 0.0);
  EXPECT_DOUBLE_EQ(limits[1].c / limits[1].a, 4.0);
  EXPECT_EQ(limits[1].b, 0.0);
}

TEST(Enclosures, OfATriangleAreTheTriangle) {
  // x + y ≤ 2 from the corner: width + height ≤ 2.
  const auto limits = limits_along_axes({{0, 0}, {2, 0}, {0, 2}});
  ASSERT_EQ(limits.size(), 1U);
  EXPECT_DOUBLE_EQ(limits[0].c / limits[0].a, 2.0);
  EXPECT_DOUBLE_EQ(limits[0].c / limits[0].b, 2.0);
}

TEST(Enclosures, OfARegularHexagonAreTwoTrianglesAndThreeStrips) {
  Points points;
  for (int i = 0; i < 6; ++i) {
    points.push_back({std::cos(i * M_PI / 3.0), std::sin(i * M_PI / 3.0)});
  }
  EXPECT_EQ(limits_along_axes(points).size(), 5U);
}

TEST(Enclosures, AreAtMostEightAndBalanceTheirNormals) {
  std::mt19937 random(4);
  for (int i = 0; i < 2000; ++i) {
    const PlanarPolygon polygon(tests::random_polygon(random));
    const auto all = enclosures(polygon.sides());
    EXPECT_GE(all.size(), 1U);
    EXPECT_LE(all.size(), 8U);
    for (const Enclosure& enclosure : all) {
      double a = 0.0;
      double b = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_GE(enclosure.weights[k], 0.0);
        a += enclosure.weights[k] * polygon.sides()[enclosure.sides[k]].a;
        b += enclosure.weights[k] * polygon.sides()[enclosure.sides[k]].b;
      }
      EXPECT_NEAR(a, 0.0, 1e-15);
      EXPECT_NEAR(b, 0.0, 1e-15);
    }
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
