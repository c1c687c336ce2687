#include "reconstruct/geometry/section_basis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

Plane plane_of(const Vector3& normal) {
  return Plane::from_normal(normal, {});
}

void expect_basis(BasisKind kind, const Vector3& normal, const Vector3& p, const Vector3& q) {
  const SectionBasis basis = section_basis(kind, plane_of(normal));
  EXPECT_NEAR(norm(basis.p - p), 0.0, 1e-15);
  EXPECT_NEAR(norm(basis.q - q), 0.0, 1e-15);
}

TEST(SectionBasis, LayerIsTheLayersOwnAxesAlongALayer) {
  const SectionBasis basis = section_basis(BasisKind::layer, plane_of({0, 0, -2}));
  EXPECT_EQ(basis.p, (Vector3{1, 0, 0}));
  EXPECT_EQ(basis.q, (Vector3{0, 1, 0}));
}

TEST(SectionBasis, XzIsTheAxesXAndZInAPlaneAlongThem) {
  const SectionBasis basis = section_basis(BasisKind::xz, plane_of({0, 3, 0}));
  EXPECT_EQ(basis.p, (Vector3{1, 0, 0}));
  EXPECT_EQ(basis.q, (Vector3{0, 0, 1}));
}

TEST(SectionBasis, IsTheAxesInPlanesAlongTwoOfThem) {
  expect_basis(BasisKind::layer, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  expect_basis(BasisKind::layer, {0, 1, 0}, {1, 0, 0}, {0, 0, 1});
  expect_basis(BasisKind::xz, {1, 0, 0}, {0, 0, 1}, {0, 1, 0});
  expect_basis(BasisKind::xz, {0, 0, 1}, {1, 0, 0}, {0, 1, 0});
}

TEST(SectionBasis, IsAsThePaperHasItForATiltedPlane) {
  const double root = std::sqrt(5.0);
  // A, B, C = 1, 2, 2: M = √(4+16+25) = 3√5, L = √(4+25+16) = 3√5.
  expect_basis(BasisKind::layer, {1, 2, 2}, {2 / root, -1 / root, 0},
               {-2 / (3 * root), -4 / (3 * root), 5 / (3 * root)});
  expect_basis(BasisKind::xz, {1, 2, 2}, {2 / root, 0, -1 / root},
               {-2 / (3 * root), 5 / (3 * root), -4 / (3 * root)});
}

TEST(SectionBasis, IsOrthonormalAndLiesInThePlaneForRandomPlanes) {
  std::mt19937 random(3);
  std::normal_distribution<double> direction;
  for (int i = 0; i < 2000; ++i) {
    const double tilt = std::pow(10.0, -(i % 10));  // down to nearly along a layer
    const Plane plane =
        plane_of({tilt * direction(random), tilt * direction(random), direction(random)});
    for (const BasisKind kind : {BasisKind::layer, BasisKind::xz}) {
      const SectionBasis basis = section_basis(kind, plane);
      EXPECT_NEAR(norm(basis.p), 1.0, 1e-15);
      EXPECT_NEAR(norm(basis.q), 1.0, 1e-15);
      EXPECT_NEAR(dot(basis.p, basis.q), 0.0, 1e-15);
      EXPECT_NEAR(dot(basis.p, plane.normal()), 0.0, 1e-15);
      EXPECT_NEAR(dot(basis.q, plane.normal()), 0.0, 1e-15);
      EXPECT_EQ(kind == BasisKind::layer ? basis.p.z : basis.p.y, 0.0);
    }
  }
}

TEST(SectionBasis, FollowsTheRuleOfSignsWhateverTheSignOfTheNormal) {
  for (int a = -2; a <= 2; ++a) {
    for (int b = -2; b <= 2; ++b) {
      for (int c = -2; c <= 2; ++c) {
        if (a == 0 && b == 0 && c == 0) {
          continue;
        }
        const Vector3 normal{static_cast<double>(a), static_cast<double>(b),
                             static_cast<double>(c)};
        const SectionBasis layer = section_basis(BasisKind::layer, plane_of(normal));
        EXPECT_GE(layer.q.z, 0.0);
        EXPECT_TRUE(layer.p.x > 0.0 || (layer.p.x == 0.0 && layer.p.y > 0.0));
        const SectionBasis xz = section_basis(BasisKind::xz, plane_of(normal));
        EXPECT_GE(xz.q.y, 0.0);
        EXPECT_TRUE(xz.p.x > 0.0 || (xz.p.x == 0.0 && xz.p.z > 0.0));
        for (const BasisKind kind : {BasisKind::layer, BasisKind::xz}) {
          const SectionBasis one = section_basis(kind, plane_of(normal));
          const SectionBasis other = section_basis(kind, plane_of(-1.0 * normal));
          EXPECT_EQ(one.p, other.p);
          EXPECT_EQ(one.q, other.q);
        }
      }
    }
  }
}

void expect_signs_of_the_rule(const Plane& plane) {
  const SectionBasis layer = section_basis(BasisKind::layer, plane);
  EXPECT_GE(layer.q.z, 0.0);
  EXPECT_TRUE(layer.p.x > 0.0 || (layer.p.x == 0.0 && layer.p.y > 0.0));
  const SectionBasis xz = section_basis(BasisKind::xz, plane);
  EXPECT_GE(xz.q.y, 0.0);
  EXPECT_TRUE(xz.p.x > 0.0 || (xz.p.x == 0.0 && xz.p.z > 0.0));
}

void expect_one_basis(const Plane& one, const Plane& other) {
  for (const BasisKind kind : {BasisKind::layer, BasisKind::xz}) {
    EXPECT_EQ(section_basis(kind, one).p, section_basis(kind, other).p);
    EXPECT_EQ(section_basis(kind, one).q, section_basis(kind, other).q);
  }
}

// Points on a small lattice, so that planes along axes, faces and diagonals are among them, and
// points anywhere.
TEST(SectionBasis, IsTheSameToTheLastBitForAllOrdersOfThePointsAndBothSignsOfTheNormal) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> anywhere(-1e5, 1e5);
  int planes = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto coordinate = [&] {
      return i % 2 == 0 ? 10.0 * static_cast<double>(random() % 3) : anywhere(random);
    };
    std::array<Vector3, 3> points;
    for (Vector3& point : points) {
      point = {coordinate(), coordinate(), coordinate()};
    }
    if (norm(cross(points[1] - points[0], points[2] - points[0])) == 0.0) {
      continue;
    }
    const Plane first = Plane::through_points(points[0], points[1], points[2]);
    expect_signs_of_the_rule(first);
    std::array<int, 3> order{0, 1, 2};
    do {
      const Plane plane =
          Plane::through_points(points[order[0]], points[order[1]], points[order[2]]);
      expect_one_basis(first, plane);
      expect_one_basis(Plane::from_normal(plane.normal(), points[0]),
                       Plane::from_normal(-1.0 * plane.normal(), points[0]));
    } while (std::next_permutation(order.begin(), order.end()));
    ++planes;
  }
  EXPECT_GT(planes, 2000);
}

// Three other points of the same plane give its picture the same way up.
TEST(SectionBasis, DoesNotDependOnWhichPointsOfThePlaneAreGiven) {
  std::mt19937 random(5);
  std::normal_distribution<double> direction;
  std::uniform_real_distribution<double> place(-1e4, 1e4);
  for (int i = 0; i < 1000; ++i) {
    const Plane plane = plane_of({direction(random), direction(random), direction(random)});
    const SectionBasis basis = section_basis(BasisKind::layer, plane);
    const auto point = [&] { return place(random) * basis.p + place(random) * basis.q; };
    const Vector3 a = point();
    const Plane other = Plane::through_points(a, a + 5e3 * basis.p, a + 3e3 * basis.q);
    for (const BasisKind kind : {BasisKind::layer, BasisKind::xz}) {
      EXPECT_NEAR(norm(section_basis(kind, other).p - section_basis(kind, plane).p), 0.0, 1e-9);
      EXPECT_NEAR(norm(section_basis(kind, other).q - section_basis(kind, plane).q), 0.0, 1e-9);
    }
  }
}

TEST(SectionBasis, IsNamedAsInTheOptions) {
  EXPECT_EQ(basis_kind("layer"), BasisKind::layer);
  EXPECT_EQ(basis_kind("xz"), BasisKind::xz);
  EXPECT_THROW(basis_kind("yz"), InvalidRequest);
}

}  // namespace
}  // namespace biotomy::reconstruct
