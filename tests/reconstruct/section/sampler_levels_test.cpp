#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <sys/resource.h>

#include "reconstruct/section/sampler.hpp"
#include "tests/reconstruct/section/sampler_reference.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::Agreement;
using tests::agreement_on_random_planes;
using tests::centre;
using tests::grid_for;
using tests::kBackground;
using tests::level_at;
using tests::MemorySource;
using tests::noise;

TEST(SamplerOfAPyramid, MixesTheLevelsThatALargePixelIsMadeOf) {
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

TEST(SamplerOfAPyramid, OfABlockThatIsBeingGroundDarkensNothingAboveTheNewestFace) {
  for (const int present : {1, 18, 25, 40}) {
    MemorySource source;
    source.box = {{97, 83, 41}, {5.0, 5.0, 9.0}};
    source.pyramid = true;
    source.present = present;
    source.voxel = noise(source.box.size, source.most(), 26);
    for (const BasisKind basis : {BasisKind::layer, BasisKind::xz}) {
      for (const Interpolation kind :
           {Interpolation::linear, Interpolation::nearest, Interpolation::cubic}) {
        const Agreement agreement = agreement_on_random_planes(source, basis, kind, 27, {1.0, 5.0});
        EXPECT_LE(agreement.worst, kind == Interpolation::nearest ? 0 : 1) << present;
      }
    }
  }
}

TEST(SamplerOfAPyramid, APixelOfTheSizeOfAVoxelStaysExactWhereThereIsAPyramid) {
  MemorySource source;
  source.pyramid = true;
  source.voxel = noise(source.box.size, 255, 23);
  ASSERT_GT(source.levels(), 1);
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 110});
  const SampledImage sampled =
      sample_grid(source, grid_for(plane, source.box, 10.0), Interpolation::linear, kBackground);
  EXPECT_EQ(sampled.statistics.levels, std::vector{0});
  for (int v = 0; v < 30; ++v) {
    for (int u = 0; u < 40; ++u) {
      ASSERT_EQ(level_at(sampled.image, u, v, 1), source.voxel(u, v, 11, 1));
    }
  }
}

TEST(SamplerOfAPyramid, ALayerThinnerThanItsPixelsIsThatLayerToTheBit) {
  for (const Interpolation kind :
       {Interpolation::linear, Interpolation::nearest, Interpolation::cubic}) {
    MemorySource source;
    source.box.spacing = {20.0, 20.0, 10.0};
    source.pyramid = true;
    source.voxel = noise(source.box.size, 255, 24);
    const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 110});
    const SampledImage sampled =
        sample_grid(source, grid_for(plane, source.box, 20.0), kind, kBackground);
    ASSERT_EQ(sampled.image.size(), cv::Size(40, 30));
    for (int v = 0; v < 30; ++v) {
      for (int u = 0; u < 40; ++u) {
        ASSERT_EQ(level_at(sampled.image, u, v, 1), source.voxel(u, v, 11, 1));
      }
    }
  }
}

std::int64_t peak_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

// Pixels so large that a tile is one pixel: a rectangle that anybody may ask for.
TEST(SamplerOfAPyramid, PlansNothingForWhatLiesBesideTheBlock) {
  MemorySource source;
  source.pyramid = true;
  source.voxel = [](int, int, int, int) { return 100; };
  const ThetaRectangle rectangle{{0, 0, 0}, {{1, 0, 0}, {0, 1, 0}}, 1e12, 0.0};
  const PixelGrid grid{rectangle, 1e6, 1'000'000, 1};
  const std::int64_t before = peak_bytes();
  const SampledImage sampled = sample_grid(source, grid, Interpolation::linear, kBackground);
  constexpr std::int64_t kPicture = 3'000'000;
  EXPECT_LT(peak_bytes() - before, 10 * kPicture);
  EXPECT_EQ(level_at(sampled.image, 0, 0, 1), 100);
  for (const int column : {1, 255, 256, 500'000, 999'999}) {
    ASSERT_EQ(level_at(sampled.image, column, 0, 1), kBackground[1]) << column;
  }
}

TEST(SamplerOfAPyramid, ASectionAlongALayerOfALevelIsThatLayerToTheBit) {
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
      EXPECT_EQ(sampled.statistics.levels, std::vector{number});
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
TEST(SamplerOfAPyramid, CoarseLevelsReachToTheFacesOfTheCuboid) {
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

TEST(SamplerOfAPyramid, LargePixelsOfAZonePlateShowNoMoire) {
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

}  // namespace
}  // namespace biotomy::reconstruct
