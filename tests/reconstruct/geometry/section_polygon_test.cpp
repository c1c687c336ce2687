#include "reconstruct/geometry/section_polygon.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;

// Extent 90 × 190 × 290.
const Cuboid kCuboid{{10, 20, 30}, {10.0, 10.0, 10.0}};

std::string refusal(const Plane& plane) {
  try {
    section_polygon(plane, kCuboid);
  } catch (const SampleError& error) {
    return error.what();
  }
  return "no error";
}

void expect_convex_polygon(const std::vector<Vector3>& polygon, const Plane& plane,
                           const Cuboid& cuboid) {
  const Vector3 far = cuboid.extent();
  const double near_enough = 1e-9 * norm(far);
  ASSERT_GE(polygon.size(), 3U);
  ASSERT_LE(polygon.size(), 6U);
  int left_turns = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3& point = polygon[i];
    EXPECT_NEAR(plane.signed_distance(point), 0.0, near_enough);
    EXPECT_GE(point.x, 0.0);
    EXPECT_GE(point.y, 0.0);
    EXPECT_GE(point.z, 0.0);
    EXPECT_LE(point.x, far.x);
    EXPECT_LE(point.y, far.y);
    EXPECT_LE(point.z, far.z);
    const Vector3& next = polygon[(i + 1) % polygon.size()];
    const Vector3& after = polygon[(i + 2) % polygon.size()];
    left_turns += dot(cross(next - point, after - next), plane.normal()) > 0.0 ? 1 : 0;
    EXPECT_GT(norm(next - point), 0.0);
  }
  EXPECT_TRUE(left_turns == 0 || left_turns == static_cast<int>(polygon.size()));
}

TEST(SectionPolygon, IsARectangleAlongALayer) {
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 100});
  EXPECT_THAT(section_polygon(plane, kCuboid),
              testing::ElementsAre(Vector3{0, 0, 100}, Vector3{90, 0, 100}, Vector3{90, 190, 100},
                                   Vector3{0, 190, 100}));
}

TEST(SectionPolygon, HasThreeVerticesWhereACornerIsCutOff) {
  const Plane plane = Plane::from_normal({1, 1, 1}, {30, 0, 0});
  const auto polygon = section_polygon(plane, kCuboid);
  ASSERT_EQ(polygon.size(), 3U);
  EXPECT_NEAR(norm(polygon[0] - Vector3{0, 0, 30}), 0.0, 1e-12);
  EXPECT_NEAR(norm(polygon[1] - Vector3{30, 0, 0}), 0.0, 1e-12);
  EXPECT_NEAR(norm(polygon[2] - Vector3{0, 30, 0}), 0.0, 1e-12);
}

TEST(SectionPolygon, HasFourFiveOrSixVerticesAsThePlaneLies) {
  const Cuboid cube{{11, 11, 11}, {10.0, 10.0, 10.0}};
  EXPECT_EQ(section_polygon(Plane::from_normal({1, 0, 1}, {45, 0, 45}), cube).size(), 4U);
  EXPECT_EQ(section_polygon(Plane::from_normal({1, 1, 2}, {75, 75, 0}), cube).size(), 5U);
  EXPECT_EQ(section_polygon(Plane::from_normal({1, 1, 1}, {50, 50, 50}), cube).size(), 6U);
}

TEST(SectionPolygon, MergesVerticesWhereThePlaneGoesThroughCorners) {
  const Plane diagonal = Plane::through_points({0, 0, 0}, {90, 190, 0}, {0, 0, 290});
  EXPECT_EQ(section_polygon(diagonal, kCuboid).size(), 4U);
  const Plane three_corners = Plane::through_points({90, 0, 0}, {0, 190, 0}, {0, 0, 290});
  EXPECT_EQ(section_polygon(three_corners, kCuboid).size(), 3U);
}

TEST(SectionPolygon, IsTheFaceOfTheCuboidThatThePlaneLiesIn) {
  for (const Plane& plane :
       {Plane::from_normal({0, 0, 1}, {0, 0, 0}), Plane::from_normal({0, 0, 1}, {0, 0, 290}),
        Plane::from_normal({1, 0, 0}, {90, 0, 0}), Plane::from_normal({0, -1, 0}, {0, 190, 0})}) {
    const auto polygon = section_polygon(plane, kCuboid);
    EXPECT_EQ(polygon.size(), 4U);
    expect_convex_polygon(polygon, plane, kCuboid);
  }
}

TEST(SectionPolygon, SurvivesRoundingAtAFace) {
  const Cuboid cuboid{{4, 4, 4}, {0.1, 0.1, 0.1}};
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 0.1 + 0.2});  // 3 · 0.1 is less
  EXPECT_EQ(section_polygon(plane, cuboid).size(), 4U);
}

TEST(SectionPolygon, IsConvexAndLiesOnThePlaneAndInTheCuboidForRandomPlanes) {
  std::mt19937 random(7);
  std::normal_distribution<double> direction;
  std::uniform_real_distribution<double> part(0.0, 1.0);
  const Cuboid cuboid{{2000, 1500, 300}, {3.3, 3.4, 40.0}};
  const Vector3 far = cuboid.extent();
  std::array<int, 7> seen{};
  for (int i = 0; i < 5000; ++i) {
    const Plane plane =
        Plane::from_normal({direction(random), direction(random), direction(random)},
                           {part(random) * far.x, part(random) * far.y, part(random) * far.z});
    const auto polygon = section_polygon(plane, cuboid);
    expect_convex_polygon(polygon, plane, cuboid);
    ++seen[polygon.size()];
  }
  for (std::size_t vertices = 3; vertices <= 6; ++vertices) {
    EXPECT_GT(seen[vertices], 0) << vertices;
  }
}

/// A point of the lattice 0, 1, 2 along each axis: a corner, the middle of an edge or of a face, or
/// the centre of the box.
struct LatticePoint {
  int x = 0;
  int y = 0;
  int z = 0;

  LatticePoint operator-(const LatticePoint& other) const {
    return {x - other.x, y - other.y, z - other.z};
  }
};

int product(const LatticePoint& a, const LatticePoint& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

LatticePoint across(const LatticePoint& a, const LatticePoint& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

LatticePoint lattice_point(int number) {
  return {number % 3, number / 3 % 3, number / 9};
}

// In whole numbers, thus exact: corners on the plane, and edges whose ends lie on both sides of it.
int exact_count_of_vertices(const LatticePoint& normal, const LatticePoint& through) {
  std::array<int, 8> sides{};
  int vertices = 0;
  for (unsigned i = 0; i < 8; ++i) {
    const LatticePoint corner{(i & 1U) != 0 ? 2 : 0, (i & 2U) != 0 ? 2 : 0, (i & 4U) != 0 ? 2 : 0};
    sides[i] = product(normal, corner - through);
    vertices += sides[i] == 0 ? 1 : 0;
  }
  for (unsigned i = 0; i < 8; ++i) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      vertices += (i & axis) == 0 && sides[i] * sides[i | axis] < 0 ? 1 : 0;
    }
  }
  return vertices;
}

/// 3 × 3 × 3 voxels, the lattice being their centres.
class SectionPolygonOfLatticePlanes : public testing::TestWithParam<Vector3> {};

// All planes through three lattice points: through corners, edges, faces and diagonals, and between
// them. Rounding must neither double a vertex nor lose one, whatever the spacing.
TEST_P(SectionPolygonOfLatticePlanes, HasExactlyTheVerticesOfWholeNumbers) {
  const Cuboid cuboid{{3, 3, 3}, GetParam()};
  const auto place = [&](const LatticePoint& p) {
    return Vector3{p.x * cuboid.spacing.x, p.y * cuboid.spacing.y, p.z * cuboid.spacing.z};
  };
  std::array<int, 7> seen{};
  for (int i = 0; i < 27; ++i) {
    for (int k = i + 1; k < 27; ++k) {
      for (int l = k + 1; l < 27; ++l) {
        const LatticePoint a = lattice_point(i);
        const LatticePoint b = lattice_point(k);
        const LatticePoint c = lattice_point(l);
        const LatticePoint normal = across(b - a, c - a);
        if (product(normal, normal) == 0) {
          continue;  // on one line
        }
        const int expected = exact_count_of_vertices(normal, a);
        const Plane plane = Plane::through_points(place(a), place(b), place(c));
        ASSERT_EQ(contact(plane, cuboid).vertices.size(), static_cast<std::size_t>(expected))
            << i << ' ' << k << ' ' << l;
        ++seen[static_cast<std::size_t>(expected)];
        if (expected >= 3) {
          expect_convex_polygon(section_polygon(plane, cuboid), plane, cuboid);
        } else {
          EXPECT_THROW(section_polygon(plane, cuboid), SampleError);
        }
      }
    }
  }
  EXPECT_GT(seen[3], 0);
  EXPECT_GT(seen[4], 0);
  EXPECT_GT(seen[5], 0);
  EXPECT_GT(seen[6], 0);
}

INSTANTIATE_TEST_SUITE_P(, SectionPolygonOfLatticePlanes,
                         testing::Values(Vector3{1e-3, 1e-3, 1e-3}, Vector3{0.1, 0.3, 0.7},
                                         Vector3{10, 10, 20}, Vector3{3.3, 3.4, 40},
                                         Vector3{1e6, 1e6, 1e6}, Vector3{1.0, 1e3, 1e4},
                                         Vector3{1e4, 7.7, 0.3}, Vector3{1e-3, 1.0, 1e2}));

TEST(SectionPolygon, IsTheSameAtEveryScale) {
  std::mt19937 random(8);
  std::normal_distribution<double> direction;
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    const Vector3 normal{direction(random), direction(random), direction(random)};
    const Vector3 place{part(random), part(random), part(random)};
    std::vector<Vector3> at_one;
    for (const double scale : {1.0, 1e-3, 1e3, 1e6}) {
      const Cuboid cuboid{{200, 100, 30}, {3.3 * scale, 3.4 * scale, 40.0 * scale}};
      const Vector3 far = cuboid.extent();
      const auto polygon = section_polygon(
          Plane::from_normal(normal, {place.x * far.x, place.y * far.y, place.z * far.z}), cuboid);
      at_one = at_one.empty() ? polygon : at_one;
      ASSERT_EQ(polygon.size(), at_one.size());
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        EXPECT_NEAR(norm(polygon[k] - scale * at_one[k]), 0.0, 1e-9 * norm(far));
      }
    }
  }
}

TEST(SectionPolygon, DoesNotDependOnTheSignOfTheNormal) {
  const Plane plane = Plane::from_normal({3, -5, 7}, {45, 95, 145});
  const Plane opposite = Plane::from_normal({-3, 5, -7}, {45, 95, 145});
  EXPECT_EQ(section_polygon(plane, kCuboid), section_polygon(opposite, kCuboid));
}

TEST(SectionPolygon, SaysByHowMuchAPlaneMisses) {
  const std::string message = refusal(Plane::from_normal({0, 0, 1}, {0, 0, 300}));
  EXPECT_THAT(message, HasSubstr("misses the sample by 10 um"));
  EXPECT_DOUBLE_EQ(contact(Plane::from_normal({0, 1, 0}, {0, -25, 0}), kCuboid).distance, 25.0);
}

TEST(SectionPolygon, SaysThatAPlaneTouchesOnlyAVertex) {
  const std::string message = refusal(Plane::from_normal({1, 1, 1}, {90, 190, 290}));
  EXPECT_THAT(message, HasSubstr("only at the vertex 90,190,290"));
}

TEST(SectionPolygon, SaysThatAPlaneTouchesOnlyAnEdge) {
  const std::string message = refusal(Plane::from_normal({1, 1, 0}, {0, 0, 0}));
  EXPECT_THAT(message, HasSubstr("only along the edge from 0,0,0 to 0,0,290"));
}

TEST(SectionPolygon, IsTheWholeOfASampleOfOneLayer) {
  const Cuboid flat{{10, 20, 1}, {10.0, 10.0, 50.0}};
  EXPECT_EQ(section_polygon(Plane::from_normal({0, 0, 1}, {0, 0, 0}), flat).size(), 4U);
}

}  // namespace
}  // namespace biotomy::reconstruct
