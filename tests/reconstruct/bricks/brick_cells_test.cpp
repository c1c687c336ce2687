#include "reconstruct/bricks/brick_cells.hpp"

#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include <gmock/gmock.h>

namespace biotomy::reconstruct {
namespace {

using Shape = std::array<int, 3>;

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> kShapes{{32, 32, 32}, {8, 8, 8},   {64, 48, 40},
                                          {5, 7, 9},    {1, 16, 33}, {3, 1, 2}};
  return kShapes;
}

bool is_in(const TexelBlocks::Box& box, const Shape& texel) {
  bool is_in = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    is_in = is_in && box.first[axis] <= texel[axis] && texel[axis] < box.end[axis];
  }
  return is_in;
}

/// In how many boxes of `cells` a texel x, y, z lies.
int times_in(const BrickCells& cells, CellSet set, const Shape& texel) {
  int times = 0;
  cells.for_each_box(set, [&](const TexelBlocks::Box& box) { times += is_in(box, texel) ? 1 : 0; });
  return times;
}

TEST(BrickCells, AreTheBrickEachTexelOnce) {
  for (const Shape& shape : shapes()) {
    const BrickCells cells(shape);
    for (int z = 0; z < shape[0]; ++z) {
      for (int y = 0; y < shape[1]; ++y) {
        for (int x = 0; x < shape[2]; ++x) {
          ASSERT_EQ(times_in(cells, cells.all(), {x, y, z}), 1);
        }
      }
    }
  }
}

TEST(BrickCells, AreWholeBlocksOfTexels) {
  for (const Shape& shape : shapes()) {
    const BrickCells cells(shape);
    std::mt19937_64 random(1);
    for (int i = 0; i < 100; ++i) {
      cells.for_each_box(random() & cells.all(), [&](const TexelBlocks::Box& box) {
        for (std::size_t axis = 0; axis < 2; ++axis) {
          EXPECT_EQ(box.first[axis] % TexelBlocks::kSide, 0);
          EXPECT_TRUE(box.end[axis] % TexelBlocks::kSide == 0 || box.end[axis] == shape[2 - axis]);
        }
      });
    }
  }
}

TEST(BrickCells, HaveTheirLayers) {
  const BrickCells cells({32, 32, 32});
  const auto range = [&](CellSet set) {
    const ChunkLayers layers = cells.layers(set);
    return std::array{layers.first, layers.end};
  };
  EXPECT_EQ(range(0), (std::array{0, 0}));
  EXPECT_EQ(range(cells.all()), (std::array{0, 32}));
  EXPECT_EQ(range(BrickCells::bit(3, 1, 2)), (std::array{16, 24}));
  EXPECT_EQ(range(BrickCells::bit(0, 0, 0) | BrickCells::bit(1, 0, 1)), (std::array{0, 16}));
}

/// A plane through a point near brick (1, 1, 1).
struct RandomPlane {
  std::array<double, 3> point{};
  PlaneReach plane;

  RandomPlane(std::mt19937& random, const Shape& shape, double reach) {
    std::normal_distribution<double> direction;
    std::uniform_real_distribution<double> place(0.8, 2.2);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[axis] = shape[2 - axis] * place(random);
      plane.normal[axis] = direction(random);
      plane.offset += plane.normal[axis] * point[axis];
    }
    plane.reach = reach;
  }
};

TEST(CellsNearAPlane, HaveEveryTexelThatIsInReachOfAPointOfIt) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (const Shape& shape : shapes()) {
    const BrickCells cells(shape);
    int checked = 0;
    for (int i = 0; i < 300; ++i) {
      const RandomPlane of(random, shape, i % 2 == 0 ? 1.0 : 2.0);
      const CellSet near = CellsNearPlane(cells, shape, of.plane).of({1, 1, 1});
      for (int j = 0; j < 300; ++j) {
        // A point of the plane: one beside it, moved along the axis that leads there fastest.
        std::array<double, 3> point = of.point;
        double off = 0.0;
        std::size_t steepest = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double way = shape[2 - axis] * unit(random);
          point[axis] += way;
          off += way * of.plane.normal[axis];
          steepest = std::abs(of.plane.normal[axis]) > std::abs(of.plane.normal[steepest])
                         ? axis
                         : steepest;
        }
        point[steepest] -= off / of.plane.normal[steepest];
        Shape texel{};
        bool is_inside = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          // The last whole number in reach, in either direction.
          const double edge = j % 2 == 0 ? std::floor(point[axis] + of.plane.reach)
                                         : std::ceil(point[axis] - of.plane.reach);
          texel[axis] = static_cast<int>(edge) - shape[2 - axis];
          is_inside = is_inside && texel[axis] >= 0 && texel[axis] < shape[2 - axis];
        }
        if (is_inside) {
          ASSERT_EQ(times_in(cells, near, texel), 1);
          ++checked;
        }
      }
    }
    EXPECT_GT(checked, 100);
  }
}

TEST(CellsNearAPlane, AreFew) {
  std::mt19937 random(4);
  const Shape shape{32, 32, 32};
  const BrickCells cells(shape);
  int most = 0;
  for (int i = 0; i < 1000; ++i) {
    const RandomPlane of(random, shape, 1.0);
    most = std::max(most, std::popcount(CellsNearPlane(cells, shape, of.plane).of({1, 1, 1})));
  }
  EXPECT_LE(most, 44);
  const PlaneReach along_layers{{0.0, 0.0, 1.0}, 32.0 + 12.5, 1.0};
  EXPECT_EQ(cells.layers(CellsNearPlane(cells, shape, along_layers).of({1, 0, 0})).first, 8);
  EXPECT_EQ(cells.layers(CellsNearPlane(cells, shape, along_layers).of({1, 0, 0})).end, 16);
}

TEST(CellsNearAPlane, AreAllForAPlaneThatEverythingIsNear) {
  const BrickCells cells({32, 32, 32});
  EXPECT_EQ(CellsNearPlane(cells, {32, 32, 32}, {}).of({7, 8, 9}), cells.all());
}

}  // namespace
}  // namespace biotomy::reconstruct
