#include "reconstruct/geometry/theta_rectangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/geometry/section_polygon.hpp"
#include "tests/reconstruct/geometry/random_polygon.hpp"

namespace biotomy::reconstruct {
namespace {

const Cuboid kCuboid{{100, 80, 60}, {10.0, 12.0, 50.0}};

TEST(ThetaRectangle, BoundingIsTheWholeLayerAlongALayer) {
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 150});
  const ThetaRectangle rectangle = theta_rectangle(
      theta::Bounding{}, section_polygon(plane, kCuboid), section_basis(BasisKind::layer, plane));
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
    const ThetaRectangle rectangle = theta_rectangle(theta::Bounding{}, polygon, basis);
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

std::string refusal(const ThetaChoice& choice, const Plane& plane) {
  try {
    theta_rectangle(choice, section_polygon(plane, kCuboid),
                    section_basis(BasisKind::layer, plane));
  } catch (const InvalidRequest& error) {
    return error.what();
  }
  return "no error";
}

ThetaRectangle rectangle_of(const ThetaChoice& choice, const Plane& plane) {
  return theta_rectangle(choice, section_polygon(plane, kCuboid),
                         section_basis(BasisKind::layer, plane));
}

TEST(ThetaRectangle, OfALayerIsTheWholeLayerToTheLastBitByEveryRule) {
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 150});
  for (const ThetaChoice& choice : {ThetaChoice(theta::Bounding{}), ThetaChoice(theta::Inscribed{}),
                                    ThetaChoice(theta::InscribedAny{}),
                                    ThetaChoice(theta::Custom{{0, 0, 150}, 990.0, 948.0, 0.0})}) {
    const ThetaRectangle rectangle = rectangle_of(choice, plane);
    EXPECT_EQ(rectangle.origin, (Vector3{0, 0, 150}));
    EXPECT_EQ(rectangle.axes.p, (Vector3{1, 0, 0}));
    EXPECT_EQ(rectangle.axes.q, (Vector3{0, 1, 0}));
    EXPECT_EQ(rectangle.width, 990.0);
    EXPECT_EQ(rectangle.height, 948.0);
  }
}

TEST(ThetaRectangle, InscribedLiesInTheCuboidAndOnThePlaneByEveryRule) {
  std::mt19937 random(6);
  for (int i = 0; i < 1000; ++i) {
    const Cuboid cuboid = tests::random_cuboid(random);
    const Plane plane = tests::random_plane(cuboid, random);
    const auto polygon = section_polygon(plane, cuboid);
    const SectionBasis basis = section_basis(i % 2 == 0 ? BasisKind::layer : BasisKind::xz, plane);
    const Vector3 far = cuboid.extent();
    const double tolerance = 1e-13 * norm(far);
    double largest_area = 0.0;
    for (const ThetaChoice& choice :
         {ThetaChoice(theta::Inscribed{}), ThetaChoice(theta::InscribedAtEdge{0}),
          ThetaChoice(theta::InscribedAtEdge{1}), ThetaChoice(theta::InscribedAtEdge{2}),
          ThetaChoice(theta::InscribedAny{})}) {
      const ThetaRectangle rectangle = theta_rectangle(choice, polygon, basis);
      for (const double x : {0.0, rectangle.width}) {
        for (const double y : {0.0, rectangle.height}) {
          const Vector3 corner = rectangle.origin + x * rectangle.axes.p + y * rectangle.axes.q;
          EXPECT_NEAR(plane.signed_distance(corner), 0.0, tolerance);
          EXPECT_GE(std::min({corner.x, corner.y, corner.z}), -tolerance);
          EXPECT_LE(std::max({corner.x - far.x, corner.y - far.y, corner.z - far.z}), tolerance);
        }
      }
      EXPECT_NEAR(norm(cross(rectangle.axes.p, rectangle.axes.q) - cross(basis.p, basis.q)), 0.0,
                  1e-15);
      EXPECT_GE(dot(rectangle.axes.p, basis.p), std::sqrt(0.5) - 1e-9);
      largest_area = std::max(largest_area, rectangle.width * rectangle.height);
      if (choice == ThetaChoice(theta::InscribedAny{})) {
        EXPECT_GE(rectangle.width * rectangle.height, largest_area * (1.0 - 1e-9));
      }
    }
  }
}

TEST(ThetaRectangle, IsTheSameWhateverTheSignOfTheNormal) {
  std::mt19937 random(7);
  for (int i = 0; i < 300; ++i) {
    const Plane plane = tests::random_plane(kCuboid, random);
    const Plane opposite = Plane::from_equation(-plane.normal().x, -plane.normal().y,
                                                -plane.normal().z, -plane.offset());
    for (const ThetaChoice& choice :
         {ThetaChoice(theta::Inscribed{}), ThetaChoice(theta::InscribedAny{}),
          ThetaChoice(theta::InscribedAtEdge{2})}) {
      const ThetaRectangle one = rectangle_of(choice, plane);
      const ThetaRectangle other = rectangle_of(choice, opposite);
      EXPECT_NEAR(norm(one.origin - other.origin), 0.0, 1e-9);
      EXPECT_NEAR(norm(one.axes.p - other.axes.p), 0.0, 1e-12);
      EXPECT_NEAR(one.width, other.width, 1e-9);
      EXPECT_NEAR(one.height, other.height, 1e-9);
    }
  }
}

// x + z = 990 cuts a rectangle of 990·√2 by 948 out of the block.
TEST(ThetaRectangle, OfEdgeHasASideOnThatEdge) {
  const Plane plane = Plane::from_normal({1, 0, 1}, {990, 0, 0});
  const auto polygon = section_polygon(plane, kCuboid);
  for (int edge = 0; edge < 4; ++edge) {
    const ThetaRectangle rectangle = rectangle_of(theta::InscribedAtEdge{edge}, plane);
    EXPECT_NEAR(rectangle.width * rectangle.height, 990.0 * std::sqrt(2.0) * 948.0, 1e-6);
  }
}

TEST(ThetaRectangle, RefusesAnEdgeThatIsNotThereAndSaysHowManyThereAre) {
  const Plane triangle = Plane::from_normal({1, 1, 1}, {100, 0, 0});
  for (const int edge : {-1, 3, 100}) {
    EXPECT_THAT(refusal(theta::InscribedAtEdge{edge}, triangle),
                testing::AllOf(testing::HasSubstr("no edge " + std::to_string(edge)),
                               testing::HasSubstr("has 3, numbered 0 to 2")));
  }
}

TEST(ThetaRectangle, CustomIsTakenAsItIsAndMayReachBeyondThePolygon) {
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 150});
  const ThetaRectangle rectangle =
      rectangle_of(theta::Custom{{-50, 20, 150}, 5000.0, 10.0, 90.0}, plane);
  EXPECT_EQ(rectangle.origin, (Vector3{-50, 20, 150}));
  EXPECT_EQ(rectangle.width, 5000.0);
  EXPECT_EQ(rectangle.height, 10.0);
  EXPECT_EQ(rectangle.axes.p, (Vector3{0, 1, 0}));
  EXPECT_EQ(rectangle.axes.q, (Vector3{-1, 0, 0}));
}

TEST(ThetaRectangle, CustomTurnsFromPTowardsQ) {
  const Plane plane = Plane::from_normal({1, 2, 2}, {500, 500, 500});
  const SectionBasis basis = section_basis(BasisKind::layer, plane);
  const ThetaRectangle rectangle =
      rectangle_of(theta::Custom{{500, 500, 500}, 1.0, 1.0, 30.0}, plane);
  EXPECT_NEAR(dot(rectangle.axes.p, basis.p), std::cos(M_PI / 6.0), 1e-15);
  EXPECT_NEAR(dot(rectangle.axes.p, basis.q), 0.5, 1e-15);
  EXPECT_NEAR(dot(rectangle.axes.q, basis.p), -0.5, 1e-15);
}

TEST(ThetaRectangle, CustomIsPutOnThePlaneAlongTheNormal) {
  const Plane plane = Plane::from_normal({1, 2, 2}, {500, 500, 500});
  const Vector3 on_plane{700, 400, 500};
  for (const double off : {-1000.0, 0.01, 1000.0}) {
    const ThetaRectangle rectangle =
        rectangle_of(theta::Custom{on_plane + off * plane.normal(), 1.0, 1.0, 0.0}, plane);
    EXPECT_NEAR(norm(rectangle.origin - on_plane), 0.0, 1e-10);
  }
}

TEST(ThetaRectangle, RefusesACustomOneThatIsNoRectangle) {
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 150});
  const double infinity = std::numeric_limits<double>::infinity();
  for (const theta::Custom& custom :
       {theta::Custom{{0, 0, 0}, 0.0, 1.0, 0.0}, theta::Custom{{0, 0, 0}, 1.0, -1.0, 0.0},
        theta::Custom{{0, 0, 0}, infinity, 1.0, 0.0}, theta::Custom{{0, 0, 0}, 1.0, 1.0, infinity},
        theta::Custom{{0, infinity, 0}, 1.0, 1.0, 0.0}}) {
    EXPECT_THAT(refusal(custom, plane), testing::HasSubstr("custom rectangle"));
  }
}

// Spacings from 10⁻³ to 10⁶ µm that differ up to ten-thousandfold, planes that are nearly along a
// face or nearly through a corner: the pictures of them all are without background.
TEST(ThetaRectangle, InscribedStaysInTheCuboidToAMillionthOfAVoxelWhateverTheCuboidAndThePlane) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::normal_distribution<double> direction;
  int sections = 0;
  for (int i = 0; i < 20000; ++i) {
    const double scale = std::pow(10.0, -3.0 + 5.0 * part(random));
    const auto size = [&] {
      return static_cast<std::int64_t>(2.0 * std::pow(10'000.0, part(random)));
    };
    const auto spacing = [&] { return scale * std::pow(10'000.0, part(random)); };
    const Cuboid cuboid{{size(), size(), size()}, {spacing(), spacing(), spacing()}};
    const Vector3 far = cuboid.extent();
    const auto tilt = [&] { return std::pow(10.0, -12.0 * part(random)) * direction(random); };
    const auto place = [&] {
      const double little = std::pow(10.0, -16.0 * part(random));
      return std::array<double, 3>{little, 1.0 - little, part(random)}[random() % 3];
    };
    const Plane plane =
        Plane::from_normal({tilt() / far.x, tilt() / far.y, direction(random) / far.z},
                           {place() * far.x, place() * far.y, place() * far.z});
    const auto polygon = contact(plane, cuboid).vertices;
    if (polygon.size() < 3) {
      continue;
    }
    const SectionBasis basis = section_basis(i % 2 == 0 ? BasisKind::layer : BasisKind::xz, plane);
    for (const ThetaChoice& choice :
         {ThetaChoice(theta::Inscribed{}), ThetaChoice(theta::InscribedAny{}),
          ThetaChoice(theta::InscribedAtEdge{i % 3})}) {
      const ThetaRectangle rectangle = theta_rectangle(choice, polygon, basis);
      EXPECT_GT(rectangle.width, 0.0);
      EXPECT_GT(rectangle.height, 0.0);
      for (const double x : {0.0, rectangle.width}) {
        for (const double y : {0.0, rectangle.height}) {
          const Vector3 corner = rectangle.origin + x * rectangle.axes.p + y * rectangle.axes.q;
          ASSERT_GE(corner.x, -1e-6 * cuboid.spacing.x) << i;
          ASSERT_GE(corner.y, -1e-6 * cuboid.spacing.y) << i;
          ASSERT_GE(corner.z, -1e-6 * cuboid.spacing.z) << i;
          ASSERT_LE(corner.x - far.x, 1e-6 * cuboid.spacing.x) << i;
          ASSERT_LE(corner.y - far.y, 1e-6 * cuboid.spacing.y) << i;
          ASSERT_LE(corner.z - far.z, 1e-6 * cuboid.spacing.z) << i;
        }
      }
    }
    ++sections;
  }
  EXPECT_GT(sections, 15000);
}

// A corner of the block is cut off, from all of it down to rounding errors: there is a rectangle,
// or a clear refusal.
TEST(ThetaRectangle, OfAVanishingSectionIsValidOrRefused) {
  for (double size = 1000.0; size > 1e-12; size /= 10.0) {
    const Plane plane = Plane::from_normal({1.0, 1.1, 1e-3}, {size, 0, 0});
    for (const ThetaChoice& choice :
         {ThetaChoice(theta::Inscribed{}), ThetaChoice(theta::InscribedAny{}),
          ThetaChoice(theta::InscribedAtEdge{1})}) {
      try {
        const ThetaRectangle rectangle = rectangle_of(choice, plane);
        EXPECT_GT(rectangle.width, 0.0);
        EXPECT_GT(rectangle.height, 0.0);
        EXPECT_LE(rectangle.width, 1e4 * size);
      } catch (const SampleError& error) {
        EXPECT_THAT(error.what(), testing::AnyOf(testing::HasSubstr("too thin"),
                                                 testing::HasSubstr("touches the sample")));
        EXPECT_LT(size, 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
