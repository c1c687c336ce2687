#include "reconstruct/section/sampler.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <tbb/task_arena.h>

#include "reconstruct/geometry/section_polygon.hpp"
#include "reconstruct/section/level_choice.hpp"
#include "tests/reconstruct/section/memory_source.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::MemorySource;
using tests::noise;

constexpr Colour kBackground{11, 22, 33};

PixelGrid grid_for(const Plane& plane, const Cuboid& cuboid, double pixel,
                   BasisKind kind = BasisKind::layer) {
  const auto rectangle = theta_rectangle(theta::Bounding{}, section_polygon(plane, cuboid),
                                         section_basis(kind, plane));
  return pixel_grid(rectangle, pixel, 3, 1'000'000'000);
}

int level_at(const cv::Mat& image, int column, int row, int colour) {
  return image.depth() == CV_16U ? image.at<cv::Vec3w>(row, column)[colour]
                                 : image.at<cv::Vec3b>(row, column)[colour];
}

double keys(double distance) {  // Keys 1981, equation 15
  const double u = std::abs(distance);
  return u < 1.0 ? (1.5 * u - 2.5) * u * u + 1.0
                 : (u < 2.0 ? ((-0.5 * u + 2.5) * u - 4.0) * u + 2.0 : 0.0);
}

/// The definitions of the interpolations, voxel by voxel in double precision. Where a level has no
/// voxel the border's colour goes on.
struct Reference {
  MemorySource& source;
  Interpolation kind = Interpolation::linear;

  /// Nothing where the point is outside of the cuboid.
  std::optional<double> at(const Vector3& point, double pixel, int colour) const {
    const Vector3 far = source.box.extent();
    const auto outside = [](double place, double last, double voxel) {
      return place < -1e-6 * voxel || place > last + 1e-6 * voxel;
    };
    if (outside(point.x, far.x, source.box.spacing.x) ||
        outside(point.y, far.y, source.box.spacing.y) ||
        outside(point.z, far.z, source.box.spacing.z)) {
      return std::nullopt;
    }
    const LevelChoice levels = level_choice(source, pixel, kind);
    const double finer = in_level(levels.finer, point, colour);
    return levels.part == 0.0 ? finer
                              : (1.0 - levels.part) * finer +
                                    levels.part * in_level(levels.finer + 1, point, colour);
  }

  double in_level(int number, const Vector3& point, int colour) const {
    const PyramidLevel& level = source.level(number);
    const Vector3 from_origin = point - level.origin;
    const std::array<double, 3> place{from_origin.x / level.spacing.x,
                                      from_origin.y / level.spacing.y,
                                      from_origin.z / level.spacing.z};
    const std::array<std::int64_t, 3> size{level.size.x, level.size.y, level.size.z};
    std::array<int, 3> middle{};
    std::array<std::array<double, 4>, 3> weight{};  // of voxels middle − 1 to middle + 2
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double inside = std::clamp(place[axis], 0.0, static_cast<double>(size[axis] - 1));
      middle[axis] =
          static_cast<int>(std::floor(kind == Interpolation::nearest ? inside + 0.5 : inside));
      for (int i = 0; i < 4; ++i) {
        const double distance = inside - (middle[axis] - 1 + i);
        weight[axis][static_cast<std::size_t>(i)] =
            kind == Interpolation::nearest  ? (i == 1 ? 1.0 : 0.0)
            : kind == Interpolation::linear ? std::max(0.0, 1.0 - std::abs(distance))
                                            : keys(distance);
      }
    }
    const auto voxel = [&](std::size_t axis, std::size_t i) {
      return static_cast<int>(
          std::clamp<std::int64_t>(middle[axis] - 1 + static_cast<int>(i), 0, size[axis] - 1));
    };
    double sum = 0.0;
    for (std::size_t z = 0; z < 4; ++z) {
      for (std::size_t y = 0; y < 4; ++y) {
        for (std::size_t x = 0; x < 4; ++x) {
          const double part = weight[0][x] * weight[1][y] * weight[2][z];
          if (part != 0.0) {
            sum += part * source.voxel_of(number, voxel(0, x), voxel(1, y), voxel(2, z), colour);
          }
        }
      }
    }
    return std::clamp(sum, 0.0, static_cast<double>(source.most()));
  }
};

// A centre this near to the border, in voxels, may be rounded to either side of it.
bool near_the_border(const MemorySource& source, const Vector3& point) {
  const Vector3 far = source.box.extent();
  const Vector3 spacing = source.box.spacing;
  const auto near = [](double place, double last, double voxel) {
    const double outside = std::max(-place, place - last) / voxel;
    return std::abs(outside - 1e-6) < 1e-9;
  };
  return near(point.x, far.x, spacing.x) || near(point.y, far.y, spacing.y) ||
         near(point.z, far.z, spacing.z);
}

Vector3 centre(const PixelGrid& grid, int column, int row) {
  return grid.rectangle.origin + (column * grid.pixel) * grid.rectangle.axes.p +
         (row * grid.pixel) * grid.rectangle.axes.q;
}

/// How far a picture is from the reference.
struct Agreement {
  int inside = 0;  ///< levels that were compared
  int differ = 0;  ///< of these
  int worst = 0;   ///< levels between them
};

void compare(MemorySource& source, Interpolation kind, const PixelGrid& grid, const cv::Mat& image,
             Agreement& agreement) {
  const Reference reference{source, kind};
  const int scale = source.bit_count == 16 ? 257 : 1;
  for (int v = 0; v < grid.rows; ++v) {
    for (int u = 0; u < grid.columns; ++u) {
      const Vector3 point = centre(grid, u, v);
      if (near_the_border(source, point)) {
        continue;
      }
      for (int c = 0; c < 3; ++c) {
        const std::optional<double> wanted = reference.at(point, grid.pixel, c);
        const int level = level_at(image, u, v, c);
        if (!wanted) {
          ASSERT_EQ(level, kBackground[static_cast<std::size_t>(c)] * scale);
          continue;
        }
        const int off = std::abs(level - static_cast<int>(std::lround(*wanted)));
        ++agreement.inside;
        agreement.differ += off > 0 ? 1 : 0;
        agreement.worst = std::max(agreement.worst, off);
      }
    }
  }
}

/// Pixels from `least` to `most` times the spacing along x.
struct PixelSizes {
  double least = 0.4;
  double most = 2.5;
};

Agreement agreement_on_random_planes(MemorySource& source, BasisKind basis, Interpolation kind,
                                     unsigned seed, const PixelSizes& sizes = {}) {
  std::mt19937 random(seed);
  std::normal_distribution<double> direction;
  std::uniform_real_distribution<double> part(0.1, 0.9);
  std::uniform_real_distribution<double> size(sizes.least, sizes.most);
  const Vector3 far = source.box.extent();
  Agreement agreement;
  constexpr int kPlanes = 20;
  for (int i = 0; i < kPlanes; ++i) {
    const Plane plane =
        Plane::from_normal({direction(random), direction(random), direction(random)},
                           {part(random) * far.x, part(random) * far.y, part(random) * far.z});
    const PixelGrid grid = grid_for(plane, source.box, size(random) * source.box.spacing.x, basis);
    compare(source, kind, grid, sample_grid(source, grid, kind, kBackground).image, agreement);
  }
  EXPECT_GT(agreement.inside, 10'000);
  return agreement;
}

void expect_agreement_on_random_planes(MemorySource& source, BasisKind basis, unsigned seed) {
  EXPECT_LE(agreement_on_random_planes(source, basis, Interpolation::linear, seed).worst, 1);
}

TEST(Sampler, AgreesWithTheDefinitionOnRandomPlanesOf8Bits) {
  MemorySource source;
  source.voxel = noise(source.box.size, 255, 1);
  expect_agreement_on_random_planes(source, BasisKind::layer, 11);
  expect_agreement_on_random_planes(source, BasisKind::xz, 12);
}

TEST(Sampler, AgreesWithTheDefinitionOnRandomPlanesOf16BitsInAnisotropicVoxels) {
  MemorySource source;
  source.bit_count = 16;
  source.box = {{37, 29, 11}, {3.3, 4.1, 17.0}};
  source.chunk_size = {4, 8, 16};
  source.voxel = noise(source.box.size, 65535, 2);
  expect_agreement_on_random_planes(source, BasisKind::layer, 13);
  expect_agreement_on_random_planes(source, BasisKind::xz, 14);
}

TEST(Sampler, AgreesWithTheDefinitionWhereChunksAreOneVoxelDeep) {
  MemorySource source;
  source.chunk_size = {1, 16, 16};
  source.voxel = noise(source.box.size, 255, 3);
  expect_agreement_on_random_planes(source, BasisKind::layer, 15);
}

TEST(Sampler, ASectionAlongALayerIsThatLayerToTheBit) {
  for (const int bits : {8, 16}) {
    MemorySource source;
    source.bit_count = bits;
    source.box = {{40, 30, 20}, {0.7, 0.7, 0.1}};
    source.voxel = noise(source.box.size, source.most(), 4);
    for (int k = 0; k < 20; ++k) {
      const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, k * 0.1});
      const PixelGrid grid = grid_for(plane, source.box, 0.7);
      ASSERT_EQ(grid.columns, 40);
      ASSERT_EQ(grid.rows, 30);
      const cv::Mat image = sample_grid(source, grid, Interpolation::linear, kBackground).image;
      for (int v = 0; v < 30; ++v) {
        for (int u = 0; u < 40; ++u) {
          for (int c = 0; c < 3; ++c) {
            ASSERT_EQ(level_at(image, u, v, c), source.voxel(u, v, k, c));
          }
        }
      }
    }
  }
}

TEST(Sampler, ASectionAlongALayerReadsNoOtherLayersChunks) {
  MemorySource source;
  for (int k = 0; k < 20; ++k) {
    source.asked.clear();
    const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, k * 10.0});
    sample_grid(source, grid_for(plane, source.box, 10.0), Interpolation::linear, kBackground);
    for (const ChunkIndex& index : source.asked) {
      EXPECT_EQ(index.z, k / 8) << "layer " << k;
    }
  }
}

TEST(Sampler, PlanesAlongXAndZAreReslicedToTheBit) {
  MemorySource source;
  source.voxel = noise(source.box.size, 255, 5);
  for (int j = 0; j < 30; j += 7) {
    const Plane plane = Plane::from_normal({0, 1, 0}, {0, j * 10.0, 0});
    const cv::Mat image =
        sample_grid(source, grid_for(plane, source.box, 10.0), Interpolation::linear, kBackground)
            .image;
    ASSERT_EQ(image.size(), cv::Size(40, 20));
    for (int k = 0; k < 20; ++k) {
      for (int i = 0; i < 40; ++i) {
        ASSERT_EQ(level_at(image, i, k, 1), source.voxel(i, j, k, 1));
      }
    }
  }
}

TEST(Sampler, PlanesAlongYAndZAreReslicedToTheBit) {
  MemorySource source;
  source.voxel = noise(source.box.size, 255, 6);
  const Plane plane = Plane::from_normal({-1, 0, 0}, {390, 0, 0});
  const cv::Mat image =
      sample_grid(source, grid_for(plane, source.box, 10.0), Interpolation::linear, kBackground)
          .image;
  ASSERT_EQ(image.size(), cv::Size(30, 20));
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j < 30; ++j) {
      ASSERT_EQ(level_at(image, j, k, 2), source.voxel(39, j, k, 2));
    }
  }
}

TEST(Sampler, TellsHowManyRowsAreDone) {
  MemorySource source;
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 40});
  const PixelGrid grid = grid_for(plane, source.box, 0.5);
  std::vector<std::int64_t> told;
  sample_grid(source, grid, Interpolation::linear, kBackground,
              [&](std::int64_t done, std::int64_t total) {
                EXPECT_EQ(total, grid.rows);
                told.push_back(done);
              });
  EXPECT_GT(told.size(), 2U);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), grid.rows);
}

TEST(Sampler, StopsWhenWhoIsToldThrows) {
  MemorySource source;
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 40});
  int calls = 0;
  EXPECT_THROW(
      sample_grid(source, grid_for(plane, source.box, 0.5), Interpolation::linear, kBackground,
                  [&](std::int64_t, std::int64_t) {
                    ++calls;
                    throw std::runtime_error("stop");
                  }),
      std::runtime_error);
  EXPECT_EQ(calls, 1);
}

TEST(Sampler, NearestTakesTheColourOfTheNearestVoxel) {
  for (const int bits : {8, 16}) {
    MemorySource source;
    source.bit_count = bits;
    source.box = {{37, 29, 17}, {10.0, 11.0, 20.0}};
    source.voxel = noise(source.box.size, source.most(), 8);
    for (const BasisKind basis : {BasisKind::layer, BasisKind::xz}) {
      EXPECT_EQ(agreement_on_random_planes(source, basis, Interpolation::nearest, 16).differ, 0);
    }
  }
}

TEST(Sampler, CubicAgreesWithTheDefinitionUpToTheBorders) {
  for (const int bits : {8, 16}) {
    MemorySource source;
    source.bit_count = bits;
    source.box = {{23, 19, 9}, {10.0, 9.0, 20.0}};
    source.chunk_size = {4, 8, 16};
    source.voxel = noise(source.box.size, source.most(), 17);
    for (const BasisKind basis : {BasisKind::layer, BasisKind::xz}) {
      EXPECT_LE(agreement_on_random_planes(source, basis, Interpolation::cubic, 18).worst, 1);
    }
  }
}

TEST(Sampler, CubicAlongALayerIsThatLayerToTheBit) {
  MemorySource source;
  source.voxel = noise(source.box.size, 255, 19);
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 70});
  const PixelGrid grid = grid_for(plane, source.box, 10.0);
  Agreement agreement;
  compare(source, Interpolation::cubic, grid,
          sample_grid(source, grid, Interpolation::cubic, kBackground).image, agreement);
  EXPECT_EQ(agreement.inside, 40 * 30 * 3);
  EXPECT_EQ(agreement.differ, 0);
}

// Hundreds of pixels to a brick: where steps of fixed point add up the most.
TEST(Sampler, AgreesWithTheDefinitionInLongRunsOf16Bits) {
  MemorySource source;
  source.bit_count = 16;
  source.box = {{200, 24, 20}, {1.0, 1.0, 1.0}};
  source.chunk_size = {20, 24, 200};
  source.voxel = noise(source.box.size, 65535, 20);
  for (int i = 0; i < 8; ++i) {
    const Plane plane = Plane::from_normal({0.01 * i, 1.0, 0.03 * i - 0.1}, {100, 11.3, 9.7});
    const PixelGrid grid = grid_for(plane, source.box, 0.37 + 0.01 * i, BasisKind::xz);
    Agreement agreement;
    compare(source, Interpolation::linear, grid,
            sample_grid(source, grid, Interpolation::linear, kBackground).image, agreement);
    EXPECT_LE(agreement.worst, 1);
  }
}

TEST(Sampler, MixesTheLevelsThatALargePixelIsMadeOf) {
  for (const int bits : {8, 16}) {
    MemorySource source;
    source.bit_count = bits;
    source.box = {{97, 83, 41}, {5.0, 5.0, 9.0}};
    source.pyramid = true;
    source.voxel = noise(source.box.size, source.most(), 21);
    ASSERT_GT(source.levels(), 3);
    for (const Interpolation kind :
         {Interpolation::linear, Interpolation::nearest, Interpolation::cubic}) {
      const Agreement agreement =
          agreement_on_random_planes(source, BasisKind::layer, kind, 22, {1.0, 5.0});
      EXPECT_LE(agreement.worst, kind == Interpolation::nearest ? 0 : 1);
    }
  }
}

TEST(Sampler, APixelOfTheSizeOfAVoxelStaysExactWhereThereIsAPyramid) {
  MemorySource source;
  source.pyramid = true;
  source.voxel = noise(source.box.size, 255, 23);
  ASSERT_GT(source.levels(), 1);
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 110});
  const SampledImage sampled =
      sample_grid(source, grid_for(plane, source.box, 10.0), Interpolation::linear, kBackground);
  EXPECT_EQ(sampled.statistics.finest_level, 0);
  EXPECT_EQ(sampled.statistics.levels, 1);
  for (int v = 0; v < 30; ++v) {
    for (int u = 0; u < 40; ++u) {
      ASSERT_EQ(level_at(sampled.image, u, v, 1), source.voxel(u, v, 11, 1));
    }
  }
}

TEST(Sampler, ASectionAlongALayerOfALevelIsThatLayerToTheBit) {
  for (const int bits : {8, 16}) {
    MemorySource source;
    source.bit_count = bits;
    source.box = {{48, 40, 32}, {10.0, 10.0, 10.0}};
    source.pyramid = true;
    source.voxel = noise(source.box.size, source.most(), 24);
    ASSERT_EQ(source.levels(), 4);
    for (int number = 1; number < 4; ++number) {
      const PyramidLevel& level = source.level(number);
      const int k = static_cast<int>(level.size.z / 2);
      const Vector3 origin = level.origin + Vector3{0, 0, k * level.spacing.z};
      const auto columns = static_cast<int>(level.size.x);
      const auto rows = static_cast<int>(level.size.y);
      const double pixel = level.spacing.x;
      const PixelGrid grid{
          {origin, {{1, 0, 0}, {0, 1, 0}}, (columns - 1) * pixel, (rows - 1) * pixel},
          pixel,
          columns,
          rows};
      const SampledImage sampled = sample_grid(source, grid, Interpolation::linear, kBackground);
      EXPECT_EQ(sampled.statistics.finest_level, number);
      EXPECT_EQ(sampled.statistics.levels, 1);
      for (int v = 0; v < rows; ++v) {
        for (int u = 0; u < columns; ++u) {
          for (int c = 0; c < 3; ++c) {
            ASSERT_EQ(level_at(sampled.image, u, v, c), source.voxel_of(number, u, v, k, c));
          }
        }
      }
    }
  }
}

// The first voxel of a level has its centre half a voxel inside the cuboid, the last may have it
// outside: between them and the cuboid's faces their colours go on.
TEST(Sampler, CoarseLevelsReachToTheFacesOfTheCuboid) {
  MemorySource source;
  source.box = {{41, 30, 19}, {10.0, 10.0, 10.0}};
  source.pyramid = true;
  source.voxel = [](int, int, int, int c) { return 100 + 50 * c; };
  for (const Interpolation kind :
       {Interpolation::linear, Interpolation::nearest, Interpolation::cubic}) {
    for (const double pixel : {20.0, 27.0, 40.0, 100.0}) {
      for (const double z : {0.0, 95.0, 180.0}) {
        const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, z});
        const PixelGrid grid = grid_for(plane, source.box, pixel);
        const cv::Mat image = sample_grid(source, grid, kind, kBackground).image;
        EXPECT_EQ(cv::norm(image, cv::Mat(image.size(), CV_8UC3, cv::Scalar(100, 150, 200)),
                           cv::NORM_INF),
                  0.0)
            << pixel << " " << z;
      }
    }
  }
}

TEST(Sampler, DoesNotDependOnHowMuchMemoryThereIs) {
  MemorySource source;
  source.box = {{60, 50, 40}, {10.0, 10.0, 10.0}};
  source.pyramid = true;
  source.voxel = noise(source.box.size, 255, 25);
  const Plane plane = Plane::from_normal({0.3, -0.5, 0.8}, 0.5 * source.box.extent());
  for (const double pixel : {2.0, 15.0}) {
    const PixelGrid grid = grid_for(plane, source.box, pixel);
    source.capacity = std::size_t{1} << 30;
    source.asked.clear();
    const SampledImage plenty = sample_grid(source, grid, Interpolation::linear, kBackground);
    const std::size_t asked = source.asked.size();
    source.capacity = 1;
    source.asked.clear();
    const SampledImage little = sample_grid(source, grid, Interpolation::linear, kBackground);
    EXPECT_GT(source.asked.size(), asked);  // strip by strip the same ones again
    EXPECT_EQ(cv::norm(plenty.image, little.image, cv::NORM_INF), 0.0);
    EXPECT_EQ(plenty.statistics.chunks_touched, little.statistics.chunks_touched);
  }
}

TEST(Sampler, DoesNotDependOnTheNumberOfThreads) {
  MemorySource source;
  source.box = {{90, 80, 40}, {10.0, 10.0, 10.0}};
  source.pyramid = true;
  source.voxel = noise(source.box.size, 255, 26);
  const Plane plane = Plane::from_normal({0.3, -0.5, 0.8}, 0.5 * source.box.extent());
  for (const Interpolation kind :
       {Interpolation::linear, Interpolation::nearest, Interpolation::cubic}) {
    for (const double pixel : {1.5, 13.0}) {
      const PixelGrid grid = grid_for(plane, source.box, pixel);
      const auto on = [&](int threads) {
        cv::Mat image;
        tbb::task_arena(threads).execute(
            [&] { image = sample_grid(source, grid, kind, kBackground).image; });
        return image;
      };
      EXPECT_EQ(cv::norm(on(1), on(2), cv::NORM_INF), 0.0);
    }
  }
}

/// A row of pixels along p, and one more beside it, of a volume 20 000 voxels long.
PixelGrid long_rows(const Vector3& direction, double pixel, int columns) {
  const Vector3 p = 1.0 / norm(direction) * direction;
  const Vector3 q = 1.0 / std::hypot(p.x, p.y) * Vector3{-p.y, p.x, 0};
  return {{{0, 0, 0}, {p, q}, (columns - 1) * pixel, pixel}, pixel, columns, 2};
}

TEST(Sampler, NearestDoesNotDriftOver20000Columns) {
  MemorySource source;
  source.box = {{20'001, 6, 6}, {0.1, 0.1, 0.1}};
  source.chunk_size = {8, 8, 64};
  source.voxel = [](int x, int y, int z, int c) {  // the voxel's place
    return c == 0 ? x & 255 : (c == 1 ? x >> 8 : 16 * y + z);
  };
  for (const Vector3& direction : {Vector3{1, 0, 0}, Vector3{1, 2.3e-4, 1.9e-4}}) {
    for (const double pixel : {0.1, 0.07, 0.1 / 3.0}) {
      const auto columns = static_cast<int>(2'000.0 / pixel);
      const PixelGrid grid = long_rows(direction, pixel, columns);
      const cv::Mat image = sample_grid(source, grid, Interpolation::nearest, kBackground).image;
      int checked = 0;
      for (int u = 0; u < columns; ++u) {
        const Vector3 voxel = 10.0 * centre(grid, u, 0);
        const auto is_between_voxels = [](double place) {
          return std::abs(place - std::floor(place) - 0.5) < 1e-6;
        };
        if (is_between_voxels(voxel.x) || is_between_voxels(voxel.y) ||
            is_between_voxels(voxel.z)) {
          continue;
        }
        ASSERT_EQ(level_at(image, u, 0, 0) + 256 * level_at(image, u, 0, 1), std::lround(voxel.x))
            << "column " << u;
        ASSERT_EQ(level_at(image, u, 0, 2), 16 * std::lround(voxel.y) + std::lround(voxel.z));
        ++checked;
      }
      EXPECT_GT(checked, 0.9 * columns);
    }
  }
}

// A hundredth of a voxel is a level.
TEST(Sampler, LinearDoesNotDriftOver20000Columns) {
  MemorySource source;
  source.bit_count = 16;
  source.box = {{20'001, 6, 6}, {0.1, 0.1, 0.1}};
  source.chunk_size = {8, 8, 64};
  const auto zigzag = [](int x) { return 100 * std::abs(x % 1200 - 600); };
  source.voxel = [&](int x, int y, int z, int c) {
    return c == 0 ? zigzag(x) : 1000 * (c == 1 ? y : z);
  };
  for (const Vector3& direction : {Vector3{1, 0, 0}, Vector3{1, 2.3e-4, 1.9e-4}}) {
    for (const double pixel : {0.1, 0.07, 0.1 / 3.0}) {
      const auto columns = static_cast<int>(2'000.0 / pixel);
      const PixelGrid grid = long_rows(direction, pixel, columns);
      const cv::Mat image = sample_grid(source, grid, Interpolation::linear, kBackground).image;
      for (int u = 0; u < columns; ++u) {
        const Vector3 voxel = 10.0 * centre(grid, u, 0);
        const auto left = static_cast<int>(voxel.x);
        const double wanted = zigzag(left) + (voxel.x - left) * (zigzag(left + 1) - zigzag(left));
        ASSERT_NEAR(level_at(image, u, 0, 0), wanted, 1.0) << "column " << u;
        ASSERT_NEAR(level_at(image, u, 0, 1), 1000.0 * voxel.y, 1.0);
        ASSERT_NEAR(level_at(image, u, 0, 2), 1000.0 * voxel.z, 1.0);
      }
    }
  }
}

/// A zone plate: rings around the corner, finer from ring to ring until at kPlate voxels from it a
/// voxel is half a period. Its mean is 128 all over.
constexpr int kPlate = 360;

double frequency(double radius) {  // periods a voxel
  return 0.5 * radius / kPlate;
}

int zone_plate(int x, int y, int /*z*/, int /*c*/) {
  const double square = static_cast<double>(x) * x + static_cast<double>(y) * y;
  return static_cast<int>(std::lround(128.0 + 100.0 * std::cos(CV_PI / 2.0 * square / kPlate)));
}

/// What remains of the plate where its rings are too fine for the pixels: beyond the radius at
/// which two pixels are a period.
struct Moire {
  double energy = 0.0;       ///< mean square of the deviation from the plate's mean
  double slow_energy = 0.0;  ///< that of means of 5 × 5 pixels: the false rings that the eye sees
  double slow_greatest = 0.0;  ///< and their greatest deviation
};

Moire moire_of(const cv::Mat& image, double pixel) {
  cv::Mat deviation;
  cv::extractChannel(image, deviation, 0);
  deviation.convertTo(deviation, CV_64F, 1.0, -128.0);
  cv::Mat slow;
  cv::blur(deviation, slow, cv::Size(5, 5));
  Moire moire;
  int count = 0;
  for (int v = 2; v < image.rows - 2; ++v) {
    for (int u = 2; u < image.cols - 2; ++u) {
      const double radius = std::hypot(u, v) * pixel;
      // Pixels whose neighbours, too, lie beyond the ring and on the plate.
      if (frequency(radius - 3.0 * pixel) < 0.5 / pixel || radius + 3.0 * pixel > kPlate) {
        continue;
      }
      ++count;
      moire.energy += std::pow(deviation.at<double>(v, u), 2);
      moire.slow_energy += std::pow(slow.at<double>(v, u), 2);
      moire.slow_greatest = std::max(moire.slow_greatest, std::abs(slow.at<double>(v, u)));
    }
  }
  EXPECT_GT(count, 200);
  moire.energy /= count;
  moire.slow_energy /= count;
  return moire;
}

TEST(Sampler, LargePixelsOfAZonePlateShowNoMoire) {
  MemorySource with_pyramid;
  with_pyramid.pyramid = true;
  MemorySource plain;
  for (MemorySource* source : {&with_pyramid, &plain}) {
    source->box = {{kPlate, kPlate, 4}, {1.0, 1.0, 1.0}};
    source->chunk_size = {4, 32, 32};
    source->voxel = zone_plate;
  }
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 0});
  // How many times less energy there is than by picking voxels of level 0 (measured: 2.5, 25, 21,
  // 130 in all; 1.9, 46, 57, 255 of the false rings), and how far local means may be from the
  // plate's, whose rings are 100 levels high. At 1.3 voxels there is little to be done: the finest
  // rings are hardly too fine, and picking voxels turns them into others that are almost as fine.
  struct Bound {
    double pixel;
    double factor;
    double slow_factor;
    double slow_greatest;
  };
  for (const Bound& bound : {Bound{1.3, 2.2, 1.5, 16.0}, Bound{2.0, 20.0, 40.0, 11.0},
                             Bound{2.8, 18.0, 50.0, 8.0}, Bound{5.6, 110.0, 200.0, 4.0}}) {
    const PixelGrid grid = grid_for(plane, plain.box, bound.pixel);
    const auto moire = [&](MemorySource& source) {
      return moire_of(sample_grid(source, grid, Interpolation::linear, kBackground).image,
                      bound.pixel);
    };
    const Moire filtered = moire(with_pyramid);
    const Moire picked = moire(plain);
    EXPECT_GT(picked.energy / filtered.energy, bound.factor) << bound.pixel;
    EXPECT_GT(picked.slow_energy / filtered.slow_energy, bound.slow_factor) << bound.pixel;
    EXPECT_LT(filtered.slow_greatest, bound.slow_greatest) << bound.pixel;
    if (bound.pixel >= 2.0) {
      EXPECT_GT(picked.slow_greatest, 50.0);  // the plate can tell
    }
  }
}

TEST(Sampler, ChunksThatWereNeverWrittenAreZero) {
  MemorySource source;
  source.voxel = [](int, int, int, int) { return 200; };
  source.never_written = {{0, 0, 0}};
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 30});
  const cv::Mat image =
      sample_grid(source, grid_for(plane, source.box, 10.0), Interpolation::linear, kBackground)
          .image;
  EXPECT_EQ(level_at(image, 7, 7, 0), 0);
  EXPECT_EQ(level_at(image, 8, 7, 0), 200);
}

TEST(Sampler, CountsEachChunkOnceHoweverManyTilesAskForIt) {
  MemorySource source;
  source.box = {{300, 300, 4}, {1.0, 1.0, 1.0}};
  source.chunk_size = {4, 100, 100};
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 1});
  const auto statistics =
      sample_grid(source, grid_for(plane, source.box, 1.0), Interpolation::linear, kBackground)
          .statistics;
  EXPECT_EQ(statistics.chunks_touched, 9);
  EXPECT_GT(source.asked.size(), 9U);
  EXPECT_GT(statistics.sample_s, 0.0);
}

TEST(Sampler, TakesPixelsMuchLargerThanAChunk) {
  MemorySource source;
  source.chunk_size = {2, 2, 2};
  source.voxel = noise(source.box.size, 255, 9);
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 50});
  const cv::Mat image =
      sample_grid(source, grid_for(plane, source.box, 130.0), Interpolation::linear, kBackground)
          .image;
  ASSERT_EQ(image.size(), cv::Size(4, 3));
  EXPECT_EQ(level_at(image, 3, 2, 0), source.voxel(39, 26, 5, 0));
}

TEST(Sampler, ReadsNothingBeyondASampleOfOneLayer) {
  MemorySource source;
  source.box.size.z = 1;
  source.chunk_size = {1, 8, 8};
  source.voxel = noise(source.box.size, 255, 10);
  const Vector3 origin{0, 0, -1e-6};  // a ten-millionth of a voxel off the layer: forgiven
  const PixelGrid grid =
      pixel_grid({origin, {{1, 0, 0}, {0, 1, 0}}, 390.0, 290.0}, 10.0, 3, 1'000'000);
  const cv::Mat image = sample_grid(source, grid, Interpolation::linear, kBackground).image;
  for (int v = 0; v < 30; ++v) {
    for (int u = 0; u < 40; ++u) {
      ASSERT_EQ(level_at(image, u, v, 2), source.voxel(u, v, 0, 2));
    }
  }
}

TEST(Sampler, PassesOnWhatTheSourceThrows) {
  MemorySource source;
  source.broken = true;
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 50});
  EXPECT_THROW(
      sample_grid(source, grid_for(plane, source.box, 10.0), Interpolation::linear, kBackground),
      std::runtime_error);
}

}  // namespace
}  // namespace biotomy::reconstruct
