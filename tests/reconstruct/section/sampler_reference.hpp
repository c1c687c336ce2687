#pragma once

// What the sampler is held against: the definitions of the interpolations, slowly.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "reconstruct/geometry/section_polygon.hpp"
#include "reconstruct/section/level_choice.hpp"
#include "reconstruct/section/sampler.hpp"
#include "tests/reconstruct/bricks/memory_source.hpp"

namespace biotomy::reconstruct::tests {

using biotomy::tests::MemorySource;
using biotomy::tests::noise;

inline constexpr Colour kBackground{11, 22, 33};

inline PixelGrid grid_for(const Plane& plane, const Cuboid& cuboid, double pixel,
                          BasisKind kind = BasisKind::layer) {
  const auto rectangle = theta_rectangle(theta::Bounding{}, section_polygon(plane, cuboid),
                                         section_basis(kind, plane));
  return pixel_grid(rectangle, pixel, 3, 1'000'000'000);
}

inline int level_at(const cv::Mat& image, int column, int row, int colour) {
  return image.depth() == CV_16U ? image.at<cv::Vec3w>(row, column)[colour]
                                 : image.at<cv::Vec3b>(row, column)[colour];
}

inline double keys(double distance) {  // Keys 1981, equation 15
  const double u = std::abs(distance);
  return u < 1.0 ? (1.5 * u - 2.5) * u * u + 1.0
                 : (u < 2.0 ? ((-0.5 * u + 2.5) * u - 4.0) * u + 2.0 : 0.0);
}

/// The definitions of the interpolations, voxel by voxel in double precision. Where a level has no
/// voxel the border's colour goes on; for points no deeper than the newest layer, also where no
/// layer is present.
struct Reference {
  MemorySource& source;
  Interpolation kind = Interpolation::linear;

  /// Nothing where the point is outside of the cuboid.
  std::optional<double> at(const Vector3& point, const PixelGrid& grid, int colour) const {
    const Vector3 far = source.box.extent();
    const auto outside = [](double place, double last, double voxel) {
      return place < -1e-6 * voxel || place > last + 1e-6 * voxel;
    };
    if (outside(point.x, far.x, source.box.spacing.x) ||
        outside(point.y, far.y, source.box.spacing.y) ||
        outside(point.z, far.z, source.box.spacing.z)) {
      return std::nullopt;
    }
    const LevelChoice levels = level_choice(source, grid, kind);
    const double finer = in_level(levels.finer, point, colour);
    return levels.part == 0.0 ? finer
                              : (1.0 - levels.part) * finer +
                                    levels.part * in_level(levels.coarser, point, colour);
  }

  double in_level(int number, const Vector3& point, int colour) const {
    const PyramidLevel& level = source.level(number);
    const Vector3 from_origin = point - level.origin;
    const std::array<double, 3> place{from_origin.x / level.spacing.x,
                                      from_origin.y / level.spacing.y,
                                      from_origin.z / level.spacing.z};
    std::array<std::int64_t, 3> size{level.size.x, level.size.y, level.size.z};
    if (point.z / source.box.spacing.z < static_cast<double>(source.layers_present() - 1) + 1e-6) {
      size[2] = (source.layers_present() + level.factor.z - 1) / level.factor.z;
    }
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

// A centre this near to the border or to the newest face, in voxels, may be rounded to either side
// of it.
inline bool near_the_border(const MemorySource& source, const Vector3& point) {
  const Vector3 far = source.box.extent();
  const Vector3 spacing = source.box.spacing;
  const auto near = [](double place, double last, double voxel) {
    const double outside = std::max(-place, place - last) / voxel;
    return std::abs(outside - 1e-6) < 1e-9;
  };
  const double newest = static_cast<double>(source.layers_present() - 1) * spacing.z;
  return near(point.x, far.x, spacing.x) || near(point.y, far.y, spacing.y) ||
         near(point.z, far.z, spacing.z) || near(point.z, newest, spacing.z);
}

inline Vector3 centre(const PixelGrid& grid, int column, int row) {
  return grid.rectangle.origin + (column * grid.pixel) * grid.rectangle.axes.p +
         (row * grid.pixel) * grid.rectangle.axes.q;
}

/// How far a picture is from the reference.
struct Agreement {
  int inside = 0;  ///< levels that were compared
  int differ = 0;  ///< of these
  int worst = 0;   ///< levels between them
};

inline void compare(MemorySource& source, Interpolation kind, const PixelGrid& grid,
                    const cv::Mat& image, Agreement& agreement) {
  const Reference reference{source, kind};
  const int scale = source.bit_count == 16 ? 257 : 1;
  for (int v = 0; v < grid.rows; ++v) {
    for (int u = 0; u < grid.columns; ++u) {
      const Vector3 point = centre(grid, u, v);
      if (near_the_border(source, point)) {
        continue;
      }
      for (int c = 0; c < 3; ++c) {
        const std::optional<double> wanted = reference.at(point, grid, c);
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

inline Agreement agreement_on_random_planes(MemorySource& source, BasisKind basis,
                                            Interpolation kind, unsigned seed,
                                            const PixelSizes& sizes = {}) {
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

}  // namespace biotomy::reconstruct::tests
