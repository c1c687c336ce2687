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
#include <tbb/task_arena.h>

#include "tests/reconstruct/section/sampler_reference.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::Agreement;
using tests::agreement_on_random_planes;
using tests::compare;
using tests::grid_for;
using tests::kBackground;
using tests::level_at;
using tests::MemorySource;
using tests::noise;

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

// Whole rows of pixels whose texels lie in two chunks, along each axis; some run from voxel to
// voxel, some between.
TEST(Sampler, AgreesWithTheDefinitionBetweenChunks) {
  struct Case {
    GridSize size;
    Vector3 normal;
  };
  for (const auto& [size, normal] :
       {Case{{20, 270, 12}, {-1, 0, 0}}, Case{{270, 20, 12}, {0, 1, 0}},
        Case{{270, 20, 12}, {0, 0, 1}}}) {
    for (const int bits : {8, 16}) {
      MemorySource source;
      source.bit_count = bits;
      source.box = {size, {1.0, 1.0, 1.0}};
      source.voxel = noise(source.box.size, source.most(), 21);
      for (const double pixel : {1.0, 0.9}) {
        const Plane plane = Plane::from_normal(normal, {7.6, 7.6, 7.6});
        const PixelGrid grid = grid_for(plane, source.box, pixel);
        ASSERT_GE(grid.columns, 270);
        Agreement agreement;
        compare(source, Interpolation::linear, grid,
                sample_grid(source, grid, Interpolation::linear, kBackground).image, agreement);
        EXPECT_EQ(agreement.inside, grid.columns * grid.rows * 3);
        EXPECT_LE(agreement.worst, 1);
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

TEST(Sampler, UsesAPicturesMemoryAgain) {
  MemorySource source;
  source.voxel = noise(source.box.size, 255, 27);
  cv::Mat image;
  for (const double z : {10.0, 20.0}) {
    const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, z});
    const PixelGrid grid = grid_for(plane, source.box, 10.0);
    const std::uint8_t* const memory = image.data;
    sample_grid(source, grid, Interpolation::linear, kBackground, image);
    EXPECT_TRUE(memory == nullptr || image.data == memory);
    EXPECT_EQ(level_at(image, 5, 6, 0), source.voxel(5, 6, static_cast<int>(z / 10.0), 0));
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
