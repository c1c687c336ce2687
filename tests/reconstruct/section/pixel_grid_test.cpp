#include "reconstruct/section/pixel_grid.hpp"

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

constexpr std::int64_t kMaxBytes = 2'000'000'000;
const SectionBasis kAxes{{1, 0, 0}, {0, 1, 0}};

PixelGrid grid_of(double width, double height, double pixel) {
  return pixel_grid({{0, 0, 0}, kAxes, width, height}, pixel, 3, kMaxBytes);
}

TEST(PixelGrid, HasAPixelAtBothEnds) {
  const PixelGrid grid = grid_of(90.0, 40.0, 10.0);
  EXPECT_EQ(grid.columns, 10);
  EXPECT_EQ(grid.rows, 5);
}

TEST(PixelGrid, LeavesOutAPixelThatDoesNotFit) {
  EXPECT_EQ(grid_of(99.0, 9.9, 10.0).columns, 10);
  EXPECT_EQ(grid_of(99.0, 9.9, 10.0).rows, 1);
}

TEST(PixelGrid, ForgivesAMillionthOfAPixel) {
  EXPECT_EQ(grid_of(0.1 + 0.2, 0.0, 0.1).columns, 4);
  EXPECT_EQ(grid_of(30.0 - 0.5e-5, 0.0, 10.0).columns, 4);
  EXPECT_EQ(grid_of(30.0 - 5e-5, 0.0, 10.0).columns, 3);
}

TEST(PixelGrid, RefusesAPixelThatIsNoSize) {
  for (const double pixel : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    EXPECT_THROW(grid_of(100.0, 100.0, pixel), InvalidRequest);
  }
}

TEST(PixelGrid, RefusesAnAbsurdPictureAndSaysTheLimit) {
  for (const double pixel : {1e-3, 1e-300}) {
    try {
      grid_of(1e5, 1e5, pixel);
      FAIL() << "no error";
    } catch (const SampleError& error) {
      EXPECT_THAT(std::string(error.what()), testing::HasSubstr("the limit is 2 GB"));
    }
  }
}

TEST(PixelGrid, ColumnsDoNotDriftOver20000Pixels) {
  const double spacing = 3.3;
  const Cuboid cuboid{{20001, 20001, 2}, {spacing, spacing, 10.0}};
  const PixelGrid grid = grid_of(20000 * spacing, 20000 * spacing, spacing);
  ASSERT_EQ(grid.columns, 20001);
  const VoxelRow last = voxel_row(grid, cuboid, 20000);
  EXPECT_NEAR(last.at(0, 20000), 20000.0, 1e-10);
  EXPECT_NEAR(last.at(1, 20000), 20000.0, 1e-10);
}

long double component(const Vector3& v, std::size_t axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

// What the place of a pixel is by its definition, with eleven bits more than the code has.
long double exact_place(const PixelGrid& grid, const Cuboid& cuboid, std::size_t axis, int column,
                        int row) {
  const long double pixel = grid.pixel;
  return (component(grid.rectangle.origin, axis) +
          column * pixel * component(grid.rectangle.axes.p, axis) +
          row * pixel * component(grid.rectangle.axes.q, axis)) /
         component(cuboid.spacing, axis);
}

TEST(PixelGrid, NeitherColumnNorRowOfAnyPlaneDriftsOver20000Pixels) {
  std::mt19937 random(10);
  std::normal_distribution<double> direction;
  std::uniform_real_distribution<double> spacing(0.3, 30.0);
  double largest = 0.0;
  for (int i = 0; i < 300; ++i) {
    const Cuboid cuboid{{20001, 20001, 20001}, {spacing(random), spacing(random), spacing(random)}};
    const Plane plane = Plane::from_normal(
        {direction(random), direction(random), direction(random)}, 0.5 * cuboid.extent());
    const SectionBasis basis = section_basis(i % 2 == 0 ? BasisKind::layer : BasisKind::xz, plane);
    const double least = std::min({cuboid.spacing.x, cuboid.spacing.y, cuboid.spacing.z});
    const PixelGrid grid = pixel_grid({0.5 * cuboid.extent() - 1e4 * least * (basis.p + basis.q),
                                       basis, 20000 * least, 20000 * least},
                                      least, 3, kMaxBytes);
    for (const int row : {0, 1, 9999, 20000}) {
      const VoxelRow places = voxel_row(grid, cuboid, row);
      for (const int column : {0, 1, 6667, 13333, 19999, 20000}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const long double exact = exact_place(grid, cuboid, axis, column, row);
          const double error =
              static_cast<double>(places.at(static_cast<int>(axis), column) - exact);
          largest = std::max(largest, std::abs(error));
        }
      }
    }
  }
  EXPECT_LT(largest, 2e-11);
  EXPECT_GT(largest, 0.0);  // the two are computed differently
}

TEST(PixelGrid, ARowNearlyOnVoxelCentresIsOnThem) {
  const Cuboid cuboid{{10, 10, 10}, {0.1, 0.1, 0.1}};
  const PixelGrid grid = pixel_grid({{0, 0, 0.1 * 3 + 1e-15}, kAxes, 0.9, 0.9}, 0.1, 3, kMaxBytes);
  const VoxelRow row = voxel_row(grid, cuboid, 7);
  EXPECT_EQ(row.start[2], 3.0);
  EXPECT_EQ(row.step[2], 0.0);
  EXPECT_EQ(row.start[1], 7.0);
}

TEST(PixelGrid, ARowBetweenVoxelCentresStaysThere) {
  const Cuboid cuboid{{10, 10, 10}, {1.0, 1.0, 1.0}};
  const PixelGrid grid = pixel_grid({{0, 0, 3.25}, kAxes, 9.0, 9.0}, 1.0, 3, kMaxBytes);
  EXPECT_EQ(voxel_row(grid, cuboid, 0).start[2], 3.25);
}

TEST(ColumnsInside, AreThoseWhoseCentresLieInTheCuboid) {
  const GridSize size{10, 10, 10};
  const VoxelRow row{{-2.5, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  const ColumnRange inside = columns_inside(row, {0, 100}, size);
  EXPECT_EQ(inside.first, 3);
  EXPECT_EQ(inside.last, 12);
  const ColumnRange backwards = columns_inside({{11.5, 0, 0}, {-1.0, 0, 0}}, {0, 100}, size);
  EXPECT_EQ(backwards.first, 3);
  EXPECT_EQ(backwards.last, 12);
}

TEST(ColumnsInside, ForgiveRoundingAtTheBorder) {
  const GridSize size{10, 10, 10};
  const ColumnRange inside =
      columns_inside({{-1e-9, 9.0 + 1e-9, 0.0}, {1.0, 0.0, 0.0}}, {0, 10}, size);
  EXPECT_EQ(inside.first, 0);
  EXPECT_EQ(inside.last, 10);
}

TEST(ColumnsInside, AreNoneForARowThatPassesBy) {
  const GridSize size{10, 10, 10};
  const ColumnRange beside = columns_inside({{0, 9.1, 0}, {1, 0, 0}}, {4, 9}, size);
  EXPECT_EQ(beside.first, beside.last);
  const ColumnRange across = columns_inside({{-5, 12, 0}, {1, 1, 0}}, {0, 100}, size);
  EXPECT_EQ(across.first, across.last);
}

TEST(ColumnsInside, StayWithinTheRangeAskedFor) {
  const ColumnRange inside = columns_inside({{0, 0, 0}, {0.1, 0, 0}}, {20, 30}, {10, 10, 10});
  EXPECT_EQ(inside.first, 20);
  EXPECT_EQ(inside.last, 30);
}

// Background along an edge of a picture that promises none is seen at once.
TEST(ColumnsInside, AreAllOfAnInscribedRectangle) {
  std::mt19937 random(9);
  std::int64_t pixels = 0;
  for (int i = 0; i < 2000; ++i) {
    const Cuboid cuboid = tests::random_cuboid(random);
    const Plane plane = tests::random_plane(cuboid, random);
    const auto polygon = section_polygon(plane, cuboid);
    const SectionBasis basis = section_basis(i % 2 == 0 ? BasisKind::layer : BasisKind::xz, plane);
    const double least = std::min({cuboid.spacing.x, cuboid.spacing.y, cuboid.spacing.z});
    for (const ThetaChoice& choice :
         {ThetaChoice(theta::Inscribed{}), ThetaChoice(theta::InscribedAny{}),
          ThetaChoice(theta::InscribedAtEdge{i % 3})}) {
      const PixelGrid grid =
          pixel_grid(theta_rectangle(choice, polygon, basis), least, 3, 1'000'000'000'000);
      const auto expect_all_inside = [&](int row) {
        const ColumnRange inside =
            columns_inside(voxel_row(grid, cuboid, row), {0, grid.columns}, cuboid.size);
        EXPECT_EQ(inside.first, 0) << i << " row " << row;
        EXPECT_EQ(inside.last, grid.columns) << i << " row " << row;
      };
      for (int row = 0; row < grid.rows; row += std::max(1, grid.rows / 50)) {
        expect_all_inside(row);
      }
      expect_all_inside(grid.rows - 1);
      pixels += std::int64_t{grid.columns} * grid.rows;
    }
  }
  EXPECT_GT(pixels, 1'000'000);
}

// Of a rectangle that is a millionth of a pixel too short for its last column and row.
TEST(ColumnsInside, AreAllOfAnInscribedRectangleHoweverLargeItsPixelsAre) {
  std::mt19937 random(11);
  for (int i = 0; i < 1000; ++i) {
    const Cuboid cuboid = tests::random_cuboid(random);
    const Plane plane = tests::random_plane(cuboid, random);
    const auto polygon = section_polygon(plane, cuboid);
    const SectionBasis basis = section_basis(i % 2 == 0 ? BasisKind::layer : BasisKind::xz, plane);
    ThetaRectangle rectangle = theta_rectangle(theta::InscribedAny{}, polygon, basis);
    const double pixel = std::min(rectangle.width, rectangle.height) / (3.0 - 0.9e-6);
    rectangle.width = rectangle.height = 3.0 * pixel - 0.9e-6 * pixel;
    const PixelGrid grid = pixel_grid(rectangle, pixel, 3, kMaxBytes);
    ASSERT_EQ(grid.columns, 4);
    ASSERT_EQ(grid.rows, 4);
    for (int row = 0; row < grid.rows; ++row) {
      const ColumnRange inside =
          columns_inside(voxel_row(grid, cuboid, row), {0, grid.columns}, cuboid.size);
      EXPECT_EQ(inside.first, 0) << i << " row " << row;
      EXPECT_EQ(inside.last, 4) << i << " row " << row;
    }
  }
}

TEST(ColumnsInside, AreNotForgivenAcrossThePlaneForLargePixels) {
  const Cuboid cuboid{{10, 10, 10}, {1.0, 1.0, 1.0}};
  const PixelGrid grid = pixel_grid({{0, 0, -2e-6}, kAxes, 9000.0, 9000.0}, 1000.0, 3, kMaxBytes);
  const ColumnRange inside = columns_inside(voxel_row(grid, cuboid, 0), {0, 10}, cuboid.size);
  EXPECT_EQ(inside.first, inside.last);
}

}  // namespace
}  // namespace biotomy::reconstruct
