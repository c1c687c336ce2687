#include "reconstruct/geometry/plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

TEST(Plane, GoesThroughItsThreePoints) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1e4, 1e5);
  for (int i = 0; i < 1000; ++i) {
    const std::array<Vector3, 3> points{
        Vector3{coordinate(random), coordinate(random), coordinate(random)},
        Vector3{coordinate(random), coordinate(random), coordinate(random)},
        Vector3{coordinate(random), coordinate(random), coordinate(random)}};
    const Plane plane = Plane::through_points(points[0], points[1], points[2]);
    EXPECT_NEAR(norm(plane.normal()), 1.0, 1e-15);
    for (const Vector3& point : points) {
      EXPECT_NEAR(plane.signed_distance(point), 0.0, 1e-7);
    }
  }
}

TEST(Plane, IsTheSameToTheLastBitWhateverTheOrderOfThePoints) {
  std::array<Vector3, 3> points{Vector3{0.1, 0.7, 12.3}, Vector3{3.3, 8.9, 0.01},
                                Vector3{91.7, 2.2, 5.5}};
  const Plane plane = Plane::through_points(points[0], points[1], points[2]);
  std::array<int, 3> order{0, 1, 2};
  do {
    const Plane other = Plane::through_points(points[order[0]], points[order[1]], points[order[2]]);
    EXPECT_EQ(other.normal(), plane.normal());
    EXPECT_EQ(other.offset(), plane.offset());
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Plane, RefusesThreePointsOnALine) {
  EXPECT_THROW(Plane::through_points({0, 0, 0}, {1, 2, 3}, {2, 4, 6}), InvalidRequest);
  EXPECT_THROW(Plane::through_points({0.1, 0.2, 0.3}, {0.2, 0.4, 0.6}, {0.3, 0.6, 0.9}),
               InvalidRequest);
  EXPECT_THROW(Plane::through_points({1e6, 1e6, 1e6}, {1e6 + 0.1, 1e6 + 0.1, 1e6 + 0.1},
                                     {1e6 + 0.3, 1e6 + 0.3, 1e6 + 0.3}),
               InvalidRequest);
}

TEST(Plane, RefusesPointsThatAreOnePoint) {
  EXPECT_THROW(Plane::through_points({5, 5, 5}, {5, 5, 5}, {5, 5, 5}), InvalidRequest);
  EXPECT_THROW(Plane::through_points({5, 5, 5}, {5, 5, 5}, {6, 5, 5}), InvalidRequest);
}

TEST(Plane, TakesAFlatTriangleThatIsNotALine) {
  const Plane plane = Plane::through_points({0, 0, 0}, {1e5, 0, 0}, {5e4, 1, 0});
  EXPECT_EQ(plane.normal().x, 0.0);
  EXPECT_EQ(std::abs(plane.normal().z), 1.0);
}

TEST(Plane, TakesASmallTriangle) {
  const Plane plane = Plane::through_points({1, 1, 1}, {1.001, 1, 1}, {1, 1.001, 1});
  EXPECT_EQ(std::abs(plane.normal().z), 1.0);
}

TEST(Plane, RefusesNumbersThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Plane::through_points({nan, 0, 0}, {1, 0, 0}, {0, 1, 0}), InvalidRequest);
  EXPECT_THROW(Plane::from_normal({0, infinity, 0}, {}), InvalidRequest);
  EXPECT_THROW(Plane::from_normal({0, 0, 1}, {0, 0, nan}), InvalidRequest);
  EXPECT_THROW(Plane::from_equation(1, 0, 0, infinity), InvalidRequest);
}

TEST(Plane, RefusesANormalWithoutDirection) {
  EXPECT_THROW(Plane::from_normal({0, 0, 0}, {1, 2, 3}), InvalidRequest);
  EXPECT_THROW(Plane::from_equation(0, 0, 0, 5), InvalidRequest);
}

TEST(Plane, TakesANormalOfAnyLength) {
  for (const double length : {1e-200, 1.0, 1e200}) {
    const Plane plane = Plane::from_normal({0, -3 * length, 4 * length}, {0, 0, 10});
    EXPECT_DOUBLE_EQ(plane.normal().y, -0.6);
    EXPECT_DOUBLE_EQ(plane.normal().z, 0.8);
    EXPECT_DOUBLE_EQ(plane.offset(), -8.0);
  }
}

TEST(Plane, TellsTheSidesByItsNormal) {
  const Plane plane = Plane::from_normal({0, 0, -2}, {7, 7, 100});
  EXPECT_DOUBLE_EQ(plane.signed_distance({0, 0, 0}), 100.0);
  EXPECT_DOUBLE_EQ(plane.signed_distance({0, 0, 130}), -30.0);
}

TEST(Plane, IsTheSameFromItsEquation) {
  const Plane plane = Plane::from_equation(2, -4, 4, 12);
  EXPECT_DOUBLE_EQ(plane.normal().x, 2.0 / 6.0);
  EXPECT_DOUBLE_EQ(plane.offset(), 2.0);
}

TEST(Plane, IsToTheBitThatOfItsNormalAndOffset) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-2.0, 2.0);
  for (int i = 0; i < 10'000; ++i) {
    const Vector3 normal{number(random), number(random), i % 7 == 0 ? 0.0 : number(random)};
    const Plane plane = Plane::from_normal(normal, {1e4 * number(random), 7.0, 3.0});
    const auto& [x, y, z] = plane.normal();
    const Plane again = Plane::from_equation(x, y, z, plane.offset());
    ASSERT_EQ(again.normal(), plane.normal());
    ASSERT_EQ(again.offset(), plane.offset());
  }
  EXPECT_EQ(Plane::from_equation(1.0, 1e-12, 0.0, 5.0).normal(), (Vector3{1.0, 0.0, 0.0}));
}

TEST(Plane, IsAlongAnAxisWhenOnlyRoundingSaysOtherwise) {
  const Plane plane = Plane::from_normal({1.0, 1e-17, -1e-13}, {5, 0, 0});
  EXPECT_EQ(plane.normal(), (Vector3{1.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace biotomy::reconstruct
