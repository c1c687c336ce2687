#include "reconstruct/section/tile_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "reconstruct/bricks/texel_kernels.hpp"
#include "tests/reconstruct/bricks/memory_source.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::MemorySource;

// Of a voxel: which brick a pixel that lies this near to its border needs is for rounding to say.
constexpr double kSeam = 1e-9;
constexpr double kFixedSeam = 1e-4;  // linear: steps are rounded to fixed point

double seam(Interpolation kind) {
  return kind == Interpolation::linear ? kFixedSeam : kSeam;
}

/// A tile as it was planned, and what it was planned from.
struct Planned {
  MemorySource& source;
  int level;
  Interpolation kind;
  PixelGrid grid;
  Tile tile;
  std::vector<PictureRow> rows;
  TilePlan plan;

  Planned(MemorySource& from, int number, Interpolation interpolation, const PixelGrid& pixels,
          const Tile& part)
      : source(from),
        level(number),
        kind(interpolation),
        grid(pixels),
        tile(part),
        rows(rows_of(from, number, pixels, part)),
        plan(from, number, interpolation, part, rows) {}

  int side(std::size_t axis) const { return source.chunk_size[2 - axis]; }
  /// The border of a pixel: one that is no deeper than the newest layer has it there.
  int last(std::size_t axis, const PictureRow& row, int column) const {
    const PyramidLevel& pyramid = source.level(level);
    const GridSize& size = pyramid.size;
    if (axis < 2) {
      return static_cast<int>((axis == 0 ? size.x : size.y) - 1);
    }
    const double layer = voxel_row(grid, source.box, row.row).at(2, column);
    const bool is_ground = layer < static_cast<double>(source.layers_present() - 1) + 1e-6;
    return static_cast<int>(is_ground ? (source.layers_present() - 1) / pyramid.factor.z
                                      : size.z - 1);
  }

 private:
  static std::vector<PictureRow> rows_of(MemorySource& from, int number, const PixelGrid& pixels,
                                         const Tile& part) {
    std::vector<PictureRow> result;
    for (int row = part.first_row; row < part.last_row; ++row) {
      result.emplace_back(from, number, pixels, row);
    }
    return result;
  }
};

using Check = std::function<void(const Planned&)>;

struct VolumeShape {
  const char* name;
  std::array<int, 3> chunk;  // z, y, x
  GridSize size;
  Vector3 spacing;
};

const std::vector<VolumeShape> kVolumes{
    {"cubes", {8, 8, 8}, {60, 50, 40}, {10, 10, 10}},
    {"flat chunks of anisotropic voxels", {4, 8, 16}, {61, 49, 33}, {3.3, 4.1, 17}},
    {"chunks of one layer", {1, 16, 16}, {60, 50, 40}, {10, 10, 20}},
    {"chunks of one voxel", {1, 1, 1}, {9, 8, 7}, {1, 1, 1}},
    {"needles", {1, 1, 600}, {700, 9, 8}, {1, 2, 3}},
    {"planks", {12, 600, 1024}, {1100, 1300, 30}, {1, 1, 1}},
    {"sides that are no multiples of 4", {3, 5, 7}, {30, 31, 32}, {1, 1, 1}},
    {"chunks longer than positions can count", {600, 1024, 24}, {100, 1100, 1201}, {1, 1, 1}},
    {"one layer", {1, 8, 8}, {30, 20, 1}, {1, 1, 5}},
};

/// Axes with nothing in common with the volume's, or such that pixels fall on voxels' centres and
/// bricks' borders again and again; either way up and down.
SectionBasis axes_of(int number, std::mt19937& random) {
  const double half = std::sqrt(0.5);
  const double third = std::sqrt(1.0 / 3.0);
  const std::array<SectionBasis, 8> special{{
      {{1, 0, 0}, {0, 1, 0}},
      {{-1, 0, 0}, {0, 0, 1}},
      {{0, -1, 0}, {0, 0, -1}},
      {{0, 0, -1}, {1, 0, 0}},
      {{half, -half, 0}, {0, 0, 1}},
      {{-half, 0, half}, {0, -1, 0}},
      {{0.6, 0.8, 0}, {0, 0, 1}},
      {{-third, third, -third}, {half, half, 0}},
  }};
  if (number % 3 == 0) {
    return special[static_cast<std::size_t>(number / 3) % special.size()];
  }
  std::normal_distribution<double> normal;
  Vector3 p{normal(random), normal(random), number % 3 == 1 ? normal(random) : 0.0};
  p = 1.0 / norm(p) * p;
  Vector3 q = cross(p, {normal(random), normal(random), normal(random)});
  return {p, 1.0 / norm(q) * q};
}

/// A tile somewhere in a grid around a random voxel; its edges often reach beyond the cuboid.
PixelGrid grid_of(const VolumeShape& volume, const SectionBasis& axes, double pixel,
                  std::mt19937& random) {
  const auto within = [&](std::int64_t size) {
    return static_cast<double>(random() % static_cast<unsigned>(size));
  };
  const Vector3 middle{within(volume.size.x) * volume.spacing.x,
                       within(volume.size.y) * volume.spacing.y,
                       within(volume.size.z) * volume.spacing.z};
  constexpr int kColumns = 400;
  constexpr int kRows = 12;
  const Vector3 origin = middle - (kColumns / 2 * pixel) * axes.p - (kRows / 2 * pixel) * axes.q;
  return {{origin, axes, (kColumns - 1) * pixel, (kRows - 1) * pixel}, pixel, kColumns, kRows};
}

void for_random_plans(const Check& check) {
  unsigned seed = 1;
  for (const VolumeShape& volume : kVolumes) {
    SCOPED_TRACE(volume.name);
    for (const int bits : {8, 16}) {
      MemorySource source;
      source.box = {volume.size, volume.spacing};
      source.chunk_size = volume.chunk;
      source.bit_count = bits;
      source.pyramid = true;
      std::mt19937 random(seed++);
      if (bits == 8) {
        source.present = 1 + static_cast<int>(random() % static_cast<unsigned>(volume.size.z));
      }
      for (int i = 0; i < 90; ++i) {
        const SectionBasis axes = axes_of(i, random);
        const std::array<double, 6> pixels{
            1.0,       std::sqrt(2.0),
            0.5,       std::sqrt(3.0),
            1.0 / 3.0, 0.2 + static_cast<double>(random() % 1000) * 0.003};
        const double pixel = pixels[random() % pixels.size()] * volume.spacing.x;
        const PixelGrid grid = grid_of(volume, axes, pixel, random);
        const auto first = static_cast<int>(random() % 150);
        const double steps =
            pixel / std::min({volume.spacing.x, volume.spacing.y, volume.spacing.z});
        const int width = std::min(kMostPixels, static_cast<int>(kMostVoxels / steps));
        const Tile tile{{first, first + width}, 2, 2 + static_cast<int>(random() % 10)};
        const auto level = static_cast<int>(random() % static_cast<unsigned>(source.levels()));
        for (const Interpolation kind :
             {Interpolation::linear, Interpolation::nearest, Interpolation::cubic}) {
          check(Planned(source, level, kind, grid, tile));
          if (testing::Test::HasFatalFailure()) {
            return;
          }
        }
      }
    }
  }
}

/// The bricks of one axis that the colour of a pixel, or of what lies `aside` of it, is made of, by
/// the definition of the interpolation.
std::set<int> bricks_along(const Planned& planned, const PictureRow& row, std::size_t axis,
                           int column, double aside) {
  const int last = planned.last(axis, row, column);
  const double place = row.place.at(static_cast<int>(axis), column) + aside;
  const double inside = std::clamp(place, 0.0, static_cast<double>(last));
  const bool nearest = planned.kind == Interpolation::nearest;
  const int middle = static_cast<int>(std::floor(nearest ? inside + 0.5 : inside));
  int from = middle;
  int to = middle;
  // Linear: beyond the border its colour goes on, mixed with no other.
  const bool alone = planned.kind == Interpolation::linear && (place < 0.0 || place >= last);
  if (!row.on_centres[axis] && !nearest && !alone) {
    from -= planned.kind == Interpolation::cubic ? 1 : 0;
    to += planned.kind == Interpolation::cubic ? 2 : 1;
  }
  std::set<int> bricks;
  for (int voxel = from; voxel <= to; ++voxel) {
    bricks.insert(std::clamp(voxel, 0, last) / planned.side(axis));
  }
  return bricks;
}

void add_product(const std::array<std::set<int>, 3>& along, std::set<ChunkIndex>& bricks) {
  for (const int z : along[2]) {
    for (const int y : along[1]) {
      for (const int x : along[0]) {
        bricks.insert({z, y, x});
      }
    }
  }
}

/// What a tile must touch, and what it may where pixels lie on bricks' borders.
struct TouchedBricks {
  std::set<ChunkIndex> certainly;
  std::set<ChunkIndex> perhaps;
};

TouchedBricks touched_by(const Planned& planned) {
  TouchedBricks touched;
  for (const PictureRow& row : planned.plan.rows()) {
    for (int column = row.inside.first; column < row.inside.last; ++column) {
      std::array<std::set<int>, 3> certainly;
      std::array<std::set<int>, 3> perhaps;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::set<int> below = bricks_along(planned, row, axis, column, -seam(planned.kind));
        perhaps[axis] = bricks_along(planned, row, axis, column, seam(planned.kind));
        for (const int brick : below) {
          if (perhaps[axis].contains(brick)) {
            certainly[axis].insert(brick);
          }
        }
        perhaps[axis].insert(below.begin(), below.end());
      }
      add_product(certainly, touched.certainly);
      add_product(perhaps, touched.perhaps);
    }
  }
  return touched;
}

TEST(TilePlan, NeedsTheBricksThatItsPixelsTouchAndNoOthers) {
  std::size_t needed = 0;
  for_random_plans([&](const Planned& planned) {
    const std::vector<ChunkIndex>& bricks = planned.plan.bricks();
    const std::set<ChunkIndex> listed(bricks.begin(), bricks.end());
    ASSERT_EQ(listed.size(), bricks.size()) << "a brick is listed twice";
    const TouchedBricks touched = touched_by(planned);
    ASSERT_TRUE(std::includes(listed.begin(), listed.end(), touched.certainly.begin(),
                              touched.certainly.end()))
        << "a brick is missing";
    ASSERT_TRUE(
        std::includes(touched.perhaps.begin(), touched.perhaps.end(), listed.begin(), listed.end()))
        << "a brick is not needed";
    needed += listed.size();
  });
  EXPECT_GT(needed, 10'000U);
}

TEST(TilePlan, LaysARowsPathWhereItsPixelsLie) {
  std::int64_t pixels = 0;
  for_random_plans([&](const Planned& planned) {
    if (planned.kind != Interpolation::linear) {
      return;
    }
    for (std::size_t i = 0; i < planned.plan.rows().size(); ++i) {
      const PictureRow& row = planned.plan.rows()[i];
      const RowPath& path = planned.plan.path(i);
      for (int pixel = 0; pixel < row.inside.last - row.inside.first; ++pixel, ++pixels) {
        double error = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const RowAxis& along = path.axes[axis];
          const AxisPlace at(along, pixel);
          const double voxel = at.near_brick * planned.side(axis) + at.near - along.first;
          const double place =
              std::clamp(row.place.at(static_cast<int>(axis), row.inside.first + pixel), 0.0,
                         static_cast<double>(planned.last(axis, row, row.inside.first + pixel)));
          error += std::abs(voxel + at.part - place);
        }
        ASSERT_LT(error, 3.0 * kFixedSeam);
        if (planned.source.bit_count == 16 && pixel < 32) {
          ASSERT_LT(error * planned.source.most(), 1.0);  // the sampler's tiles are no wider
        }
      }
    }
  });
  EXPECT_GT(pixels, 100'000);
}

TEST(TilePlan, FindsASupportsVoxelsAmongItsBricks) {
  std::int64_t supports = 0;
  for_random_plans([&](const Planned& planned) {
    const TilePlan& plan = planned.plan;
    if (planned.kind == Interpolation::linear) {
      return;
    }
    for (const PictureRow& row : plan.rows()) {
      for (int column = row.inside.first; column < row.inside.last; ++column, ++supports) {
        const PixelSupport support = plan.support_at(row, column);
        std::array<VoxelPlaces::Place, 3> far;
        std::array<int, 3> voxel{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double place = std::clamp(row.place.at(static_cast<int>(axis), column), 0.0,
                                          static_cast<double>(planned.last(axis, row, column)));
          const int middle = support.first[axis] + plan.support().below;
          // Of a pixel on a voxel's centre rounding may say that it lies just before the centre.
          ASSERT_LE(std::abs(place + plan.support().shift - middle - 0.5), 0.5 + kSeam);
          ASSERT_NEAR(std::remainder(place - support.part[axis], 1.0), 0.0, 1e-6);
          ASSERT_LT(support.part[axis], 1.0F);
          // The far corner of the support; where all pixels lie on centres, the voxel itself.
          voxel[axis] = std::clamp(middle + (row.on_centres[axis] ? 0 : plan.support().above), 0,
                                   planned.last(axis, row, column));
          far[axis] = plan.places()[axis].of(voxel[axis]);
          ASSERT_EQ(far[axis].texel, voxel[axis] % planned.side(axis));
          ASSERT_EQ(far[axis].offset, plan.blocks().along(axis, far[axis].texel));
        }
        const int brick =
            plan.bricks_at().at(static_cast<std::size_t>(far[0].slot + far[1].slot + far[2].slot));
        ASSERT_GE(brick, 0);
        ASSERT_EQ(plan.bricks()[static_cast<std::size_t>(brick)],
                  (ChunkIndex{voxel[2] / planned.side(2), voxel[1] / planned.side(1),
                              voxel[0] / planned.side(0)}));
      }
    }
  });
  EXPECT_GT(supports, 100'000);
}

TEST(TilePlan, OfATileBesideTheCuboidIsEmpty) {
  MemorySource source;
  const PixelGrid grid{{{-500, -500, 0}, {{1, 0, 0}, {0, 1, 0}}, 90, 90}, 10, 10, 10};
  const Planned planned(source, 0, Interpolation::linear, grid, {{0, 10}, 0, 10});
  EXPECT_TRUE(planned.plan.bricks().empty());
}

// The centres of a coarse level's first layer lie inside the cuboid, half a voxel from its face.
TEST(TilePlan, OfASectionBeforeTheFirstLayerOfALevelNeedsThatLayerAlone) {
  MemorySource source;
  source.chunk_size = {1, 8, 8};
  source.pyramid = true;
  const PixelGrid grid{{{0, 0, 0}, {{1, 0, 0}, {0, 1, 0}}, 380, 280}, 20, 20, 15};
  const Planned planned(source, 1, Interpolation::linear, grid, {{0, 20}, 0, 15});
  ASSERT_LT(voxel_row(grid, source.level(1), 0).start[2], 0.0);
  for (const ChunkIndex& brick : planned.plan.bricks()) {
    EXPECT_EQ(brick.z, 0);
  }
  EXPECT_FALSE(planned.plan.bricks().empty());
}

TEST(TilePlan, NeedsOneBrickForALayerThatLiesInOne) {
  MemorySource source;
  source.chunk_size = {8, 64, 64};
  const PixelGrid grid{{{0, 0, 50}, {{1, 0, 0}, {0, 1, 0}}, 390, 290}, 10, 40, 30};
  const Planned planned(source, 0, Interpolation::linear, grid, {{0, 40}, 0, 16});
  EXPECT_EQ(planned.plan.bricks(), (std::vector<ChunkIndex>{{0, 0, 0}}));
}

}  // namespace
}  // namespace biotomy::reconstruct
