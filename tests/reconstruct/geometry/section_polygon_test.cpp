#include "reconstruct/geometry/section_polygon.hpp"

#include <array>
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
