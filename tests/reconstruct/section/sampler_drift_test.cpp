#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "reconstruct/section/sampler.hpp"
#include "tests/reconstruct/section/sampler_reference.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::centre;
using tests::kBackground;
using tests::level_at;
using tests::MemorySource;

/// A row of pixels along p, and one more beside it, of a volume 20 000 voxels long.
PixelGrid long_rows(const Vector3& direction, double pixel, int columns) {
  const Vector3 p = 1.0 / norm(direction) * direction;
  const Vector3 q = 1.0 / std::hypot(p.x, p.y) * Vector3{-p.y, p.x, 0};
  return {{{0, 0, 0}, {p, q}, (columns - 1) * pixel, pixel}, pixel, columns, 2};
}

TEST(SamplerOfLongRows, NearestDoesNotDriftOver20000Columns) {
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
TEST(SamplerOfLongRows, LinearDoesNotDriftOver20000Columns) {
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

}  // namespace
}  // namespace biotomy::reconstruct
