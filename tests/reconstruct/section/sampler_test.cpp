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

#include "reconstruct/geometry/section_polygon.hpp"
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

// The definition, voxel by voxel in double precision; nothing where the point is outside.
struct Reference {
  const MemorySource& source;

  std::optional<double> at(const Vector3& point, int colour) const {
    const Vector3 spacing = source.box.spacing;
    const std::array<double, 3> place{point.x / spacing.x, point.y / spacing.y,
                                      point.z / spacing.z};
    const std::array<std::int64_t, 3> size{source.box.size.x, source.box.size.y, source.box.size.z};
    std::array<int, 3> low{};
    std::array<double, 3> part{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double last = static_cast<double>(size[axis] - 1);
      if (place[axis] < -1e-6 || place[axis] > last + 1e-6) {
        return std::nullopt;
      }
      const double inside = std::clamp(place[axis], 0.0, last);
      low[axis] = std::min(static_cast<int>(inside), std::max(0, static_cast<int>(last) - 1));
      part[axis] = inside - low[axis];
    }
    double sum = 0.0;
    for (int dz = 0; dz < 2; ++dz) {
      for (int dy = 0; dy < 2; ++dy) {
        for (int dx = 0; dx < 2; ++dx) {
          const double weight = (dx == 0 ? 1.0 - part[0] : part[0]) *
                                (dy == 0 ? 1.0 - part[1] : part[1]) *
                                (dz == 0 ? 1.0 - part[2] : part[2]);
          if (weight > 0.0) {
            sum += weight * source.voxel(low[0] + dx, low[1] + dy, low[2] + dz, colour);
          }
        }
      }
    }
    return sum;
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

void expect_agreement_on_random_planes(MemorySource& source, BasisKind kind, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> direction;
  std::uniform_real_distribution<double> part(0.1, 0.9);
  std::uniform_real_distribution<double> size(0.4, 2.5);
  const Reference reference{source};
  const Vector3 far = source.box.extent();
  const int scale = source.bit_count == 16 ? 257 : 1;
  int inside = 0;
  int worst = 0;
  for (int i = 0; i < 40; ++i) {
    const Plane plane =
        Plane::from_normal({direction(random), direction(random), direction(random)},
                           {part(random) * far.x, part(random) * far.y, part(random) * far.z});
    const PixelGrid grid = grid_for(plane, source.box, size(random) * source.box.spacing.x, kind);
    const cv::Mat image = sample_grid(source, grid, Interpolation::linear, kBackground).image;
    for (int v = 0; v < grid.rows; ++v) {
      for (int u = 0; u < grid.columns; ++u) {
        const Vector3 point = grid.rectangle.origin + (u * grid.pixel) * grid.rectangle.axes.p +
                              (v * grid.pixel) * grid.rectangle.axes.q;
        if (near_the_border(source, point)) {
          continue;
        }
        for (int c = 0; c < 3; ++c) {
          const std::optional<double> wanted = reference.at(point, c);
          const int level = level_at(image, u, v, c);
          if (!wanted) {
            ASSERT_EQ(level, kBackground[static_cast<std::size_t>(c)] * scale);
            continue;
          }
          ++inside;
          worst = std::max(worst, std::abs(level - static_cast<int>(std::lround(*wanted))));
        }
      }
    }
  }
  EXPECT_GT(inside, 10'000);
  EXPECT_LE(worst, 1);
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
  MemorySource source;
  source.voxel = noise(source.box.size, 255, 8);
  const Plane plane = Plane::from_normal({0.2, 0.3, 1}, 0.5 * source.box.extent());
  const PixelGrid grid = grid_for(plane, source.box, 7.0);
  const cv::Mat image = sample_grid(source, grid, Interpolation::nearest, kBackground).image;
  int inside = 0;
  for (int v = 0; v < grid.rows; ++v) {
    for (int u = 0; u < grid.columns; ++u) {
      const Vector3 point = grid.rectangle.origin + (u * grid.pixel) * grid.rectangle.axes.p +
                            (v * grid.pixel) * grid.rectangle.axes.q;
      const Vector3 far = source.box.extent();
      if (std::min({point.x, point.y, point.z, far.x - point.x, far.y - point.y, far.z - point.z}) <
          0.01) {
        continue;
      }
      ++inside;
      ASSERT_EQ(level_at(image, u, v, 0),
                source.voxel(static_cast<int>(std::lround(point.x / 10.0)),
                             static_cast<int>(std::lround(point.y / 10.0)),
                             static_cast<int>(std::lround(point.z / 10.0)), 0));
    }
  }
  EXPECT_GT(inside, 1000);
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
