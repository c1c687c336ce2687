#include "reconstruct/geometry/theta_rectangle.hpp"

#include <algorithm>
#include <random>
#include <string>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/geometry/section_polygon.hpp"

namespace biotomy::reconstruct {
namespace {

const Cuboid kCuboid{{100, 80, 60}, {10.0, 12.0, 50.0}};

TEST(ThetaRectangle, BoundingIsTheWholeLayerAlongALayer) {
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 150});
  const ThetaRectangle rectangle = theta_rectangle(
      ThetaKind::bounding, section_polygon(plane, kCuboid), section_basis(BasisKind::layer, plane));
  EXPECT_EQ(rectangle.origin, (Vector3{0, 0, 150}));
  EXPECT_EQ(rectangle.width, 990.0);
  EXPECT_EQ(rectangle.height, 948.0);
}

TEST(ThetaRectangle, BoundingHoldsThePolygonAndNoMore) {
  std::mt19937 random(5);
  std::normal_distribution<double> direction;
  for (int i = 0; i < 500; ++i) {
    const Plane plane = Plane::from_normal(
        {direction(random), direction(random), direction(random)}, 0.5 * kCuboid.extent());
    const auto polygon = section_polygon(plane, kCuboid);
    const SectionBasis basis = section_basis(BasisKind::layer, plane);
    const ThetaRectangle rectangle = theta_rectangle(ThetaKind::bounding, polygon, basis);
    double least_p = 1e9;
    double most_p = -1e9;
    double least_q = 1e9;
    double most_q = -1e9;
    for (const Vector3& vertex : polygon) {
      const double p = dot(vertex - rectangle.origin, basis.p);
      const double q = dot(vertex - rectangle.origin, basis.q);
      least_p = std::min(least_p, p);
      most_p = std::max(most_p, p);
      least_q = std::min(least_q, q);
      most_q = std::max(most_q, q);
    }
    EXPECT_NEAR(least_p, 0.0, 1e-9);
    EXPECT_NEAR(least_q, 0.0, 1e-9);
    EXPECT_NEAR(most_p, rectangle.width, 1e-9);
    EXPECT_NEAR(most_q, rectangle.height, 1e-9);
    EXPECT_NEAR(plane.signed_distance(rectangle.origin), 0.0, 1e-9);
  }
}

TEST(ThetaRectangle, RefusesANameThatIsNotThereAndSaysWhichAre) {
  EXPECT_EQ(theta_kind("bounding"), ThetaKind::bounding);
  try {
    theta_kind("inscribed");
    FAIL() << "no error";
  } catch (const InvalidRequest& error) {
    EXPECT_THAT(std::string(error.what()),
                testing::AllOf(testing::HasSubstr("inscribed"), testing::HasSubstr("bounding")));
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
