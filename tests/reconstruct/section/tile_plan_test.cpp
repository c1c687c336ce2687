#include "reconstruct/section/tile_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "reconstruct/section/texel_kernels.hpp"
#include "tests/reconstruct/section/memory_source.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::MemorySource;

constexpr double kUnit = static_cast<double>(1U << kFractionBits);
// Of a voxel: which brick a pixel that lies this near to its border needs is for rounding to say.
constexpr double kSeam = 1e-9;

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
  int last(std::size_t axis) const {
    const GridSize& size = source.level(level).size;
    return static_cast<int>((axis == 0 ? size.x : axis == 1 ? size.y : size.z) - 1);
  }
  ColumnRange inside(const PictureRow& row) const {
    const int first = std::clamp(row.inside.first, tile.columns.first, tile.columns.last);
    return {first, std::clamp(row.inside.last, first, tile.columns.last)};
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
      for (int i = 0; i < 90; ++i) {
        const SectionBasis axes = axes_of(i, random);
        const std::array<double, 6> pixels{
            1.0,       std::sqrt(2.0),
            0.5,       std::sqrt(3.0),
            1.0 / 3.0, 0.2 + static_cast<double>(random() % 1000) * 0.003};
        const double pixel = pixels[random() % pixels.size()] * volume.spacing.x;
        const PixelGrid grid = grid_of(volume, axes, pixel, random);
        const auto first = static_cast<int>(random() % 150);
        const Tile tile{{first, first + 256}, 2, 2 + static_cast<int>(random() % 10)};
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

/// The bricks of one axis that a pixel's colour is made of, by the definition of the interpolation.
std::set<int> bricks_along(const Planned& planned, const PictureRow& row, std::size_t axis,
                           double place) {
  const int last = planned.last(axis);
  const double inside = std::clamp(place, 0.0, static_cast<double>(last));
  const bool nearest = planned.kind == Interpolation::nearest;
  const int middle = static_cast<int>(std::floor(nearest ? inside + 0.5 : inside));
  int from = middle;
  int to = middle;
  if (!row.on_centres[axis] && !nearest) {
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
  for (const PictureRow& row : planned.rows) {
    const ColumnRange inside = planned.inside(row);
    for (int column = inside.first; column < inside.last; ++column) {
      std::array<std::set<int>, 3> certainly;
      std::array<std::set<int>, 3> perhaps;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double place = row.place.at(static_cast<int>(axis), column);
        const std::set<int> below = bricks_along(planned, row, axis, place - kSeam);
        perhaps[axis] = bricks_along(planned, row, axis, place + kSeam);
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

TEST(TilePlan, CoversEachInsidePixelOnce) {
  std::int64_t in_runs = 0;
  for_random_plans([&](const Planned& planned) {
    const TilePlan& plan = planned.plan;
    ASSERT_EQ(plan.rows().size(), planned.rows.size());
    std::size_t runs = 0;
    std::size_t patches = 0;
    for (std::size_t i = 0; i < plan.rows().size(); ++i) {
      const PlannedRow& row = plan.rows()[i];
      const ColumnRange inside = planned.inside(planned.rows[i]);
      ASSERT_EQ(row.first_run, runs);
      ASSERT_EQ(row.first_patch, patches);
      std::vector<int> times(static_cast<std::size_t>(planned.grid.columns));
      for (; runs < row.last_run; ++runs) {
        const PlannedRun& run = plan.runs()[runs];
        ASSERT_GE(run.count, 1);
        ASSERT_LE(run.count, kLongestRun);
        for (int column = run.column; column < run.column + run.count; ++column) {
          ++times.at(static_cast<std::size_t>(column));
        }
        in_runs += run.count;
      }
      for (; patches < row.last_patch; ++patches) {
        ++times.at(static_cast<std::size_t>(plan.patches()[patches].column));
      }
      for (int column = 0; column < planned.grid.columns; ++column) {
        ASSERT_EQ(times[static_cast<std::size_t>(column)],
                  column >= inside.first && column < inside.last ? 1 : 0);
      }
    }
    ASSERT_EQ(runs, plan.runs().size());
    ASSERT_EQ(patches, plan.patches().size());
  });
  EXPECT_GT(in_runs, 100'000);
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

/// Texel of the run's brick, and place behind it, at pixel `i` along an axis.
struct FixedPlace {
  std::int64_t texel;
  double place;  ///< in voxels of the level
};

FixedPlace fixed_place(const Planned& planned, const PlannedRow& row, const PlannedRun& run, int i,
                       std::size_t axis) {
  const std::int64_t position =
      std::int64_t{run.start[axis]} + std::int64_t{i} * std::int64_t{row.step[axis]};
  const ChunkIndex& brick = planned.plan.bricks()[static_cast<std::size_t>(run.brick)];
  const int number = axis == 0 ? brick.x : axis == 1 ? brick.y : brick.z;
  return {run.base[axis] + (position >> kFractionBits),
          number * planned.side(axis) + run.base[axis] + static_cast<double>(position) / kUnit};
}

TEST(TilePlan, RunsLieWhereTheirPixelsDo) {
  for_random_plans([](const Planned& planned) {
    for (const PlannedRow& row : planned.plan.rows()) {
      for (std::size_t i = row.first_run; i < row.last_run; ++i) {
        const PlannedRun& run = planned.plan.runs()[i];
        for (int pixel = 0; pixel < run.count; ++pixel) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const double place = row.place.at(static_cast<int>(axis), run.column + pixel);
            ASSERT_NEAR(fixed_place(planned, row, run, pixel, axis).place, place,
                        (2.0 + 0.5 * pixel) / kUnit);
          }
        }
      }
    }
  });
}

TEST(TilePlan, AddsUpToLessThanALevelInARun) {
  double worst = 0.0;
  for_random_plans([&](const Planned& planned) {
    const double levels = planned.source.most();
    for (const PlannedRow& row : planned.plan.rows()) {
      for (std::size_t i = row.first_run; i < row.last_run; ++i) {
        const PlannedRun& run = planned.plan.runs()[i];
        double error = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double place = row.place.at(static_cast<int>(axis), run.column + run.count - 1);
          error += std::abs(fixed_place(planned, row, run, run.count - 1, axis).place - place);
        }
        worst = std::max(worst, error * levels);
      }
    }
  });
  EXPECT_LT(worst, 1.0);
}

TEST(TilePlan, RunsReadNoTexelOutsideTheirBricks) {
  std::int64_t crossing = 0;
  std::int64_t backwards = 0;
  for_random_plans([&](const Planned& planned) {
    for (const PlannedRow& row : planned.plan.rows()) {
      for (std::size_t i = row.first_run; i < row.last_run; ++i) {
        const PlannedRun& run = planned.plan.runs()[i];
        backwards += std::min({row.step[0], row.step[1], row.step[2]}) < 0 ? 1 : 0;
        for (int pixel = 0; pixel < run.count; ++pixel) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            // What the kernels do with positions must fit into 31 bits.
            const std::int64_t position =
                std::int64_t{run.start[axis]} + std::int64_t{pixel} * std::int64_t{row.step[axis]};
            ASSERT_GE(position, 0);
            ASSERT_LT(position, std::int64_t{1} << 31);
            const std::int64_t texel = fixed_place(planned, row, run, pixel, axis).texel;
            const bool alone = row.on_centres[axis] || (axis == 2 && row.crosses);
            ASSERT_LE(texel + (alone ? 0 : 1), planned.side(axis) - 1)
                << "axis " << axis << " pixel " << pixel << " of " << run.count;
          }
        }
        const std::vector<ChunkIndex>& bricks = planned.plan.bricks();
        ChunkIndex lower = bricks[static_cast<std::size_t>(run.brick)];
        lower.z += row.crosses ? 1 : 0;
        ASSERT_EQ(bricks[static_cast<std::size_t>(run.lower_brick)], lower);
        if (row.crosses) {
          ++crossing;
          ASSERT_TRUE(row.one_layer);
          ASSERT_EQ(run.base[2], planned.side(2) - 1);
          ASSERT_EQ(run.lower_z, 0);
        } else if (row.one_layer) {
          ASSERT_EQ(run.lower_z, run.base[2] + (row.on_centres[2] ? 0 : 1));
        }
      }
    }
  });
  EXPECT_GT(crossing, 500);
  EXPECT_GT(backwards, 1000);
}

TEST(TilePlan, FindsThePatchesTexelsAmongItsBricks) {
  std::int64_t patches = 0;
  for_random_plans([&](const Planned& planned) {
    const TilePlan& plan = planned.plan;
    for (const PlannedRow& row : plan.rows()) {
      for (std::size_t i = row.first_patch; i < row.last_patch; ++i) {
        const PlannedPatch& patch = plan.patches()[i];
        ++patches;
        std::array<VoxelPlaces::Place, 3> far;
        std::array<int, 3> voxel{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double place = std::clamp(row.place.at(static_cast<int>(axis), patch.column), 0.0,
                                          static_cast<double>(planned.last(axis)));
          const int middle = patch.first[axis] + plan.support().below;
          ASSERT_LE(std::abs(place + plan.support().shift - middle - 0.5), 0.5);
          ASSERT_NEAR(place, std::floor(place) + patch.part[axis], 1e-6);
          ASSERT_LT(patch.part[axis], 1.0F);
          // The far corner of the support; where all pixels lie on centres, the voxel itself.
          voxel[axis] = std::clamp(middle + (row.on_centres[axis] ? 0 : plan.support().above), 0,
                                   planned.last(axis));
          far[axis] = plan.places()[axis].of(voxel[axis]);
          ASSERT_EQ(far[axis].texel, voxel[axis] % planned.side(axis));
          ASSERT_EQ(far[axis].offset, plan.blocks().along(axis, far[axis].texel));
        }
        const int brick = plan.brick_at(far[0].slot + far[1].slot + far[2].slot);
        ASSERT_GE(brick, 0);
        ASSERT_EQ(plan.bricks()[static_cast<std::size_t>(brick)],
                  (ChunkIndex{voxel[2] / planned.side(2), voxel[1] / planned.side(1),
                              voxel[0] / planned.side(0)}));
      }
    }
  });
  EXPECT_GT(patches, 100'000);
}

TEST(TilePlan, OfATileBesideTheCuboidIsEmpty) {
  MemorySource source;
  const PixelGrid grid{{{-500, -500, 0}, {{1, 0, 0}, {0, 1, 0}}, 90, 90}, 10, 10, 10};
  const Planned planned(source, 0, Interpolation::linear, grid, {{0, 10}, 0, 10});
  EXPECT_TRUE(planned.plan.runs().empty());
  EXPECT_TRUE(planned.plan.patches().empty());
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
  EXPECT_GT(planned.plan.runs().size(), 15U);
}

TEST(TilePlan, MixesAWholeLayerFromOneBrickARow) {
  MemorySource source;
  source.chunk_size = {8, 64, 64};
  const PixelGrid grid{{{0, 0, 50}, {{1, 0, 0}, {0, 1, 0}}, 390, 290}, 10, 40, 30};
  const Planned planned(source, 0, Interpolation::linear, grid, {{0, 40}, 0, 16});
  EXPECT_EQ(planned.plan.runs().size(), 16U);
  EXPECT_TRUE(planned.plan.patches().empty());
  EXPECT_EQ(planned.plan.bricks(), (std::vector<ChunkIndex>{{0, 0, 0}}));
}

}  // namespace
}  // namespace biotomy::reconstruct
