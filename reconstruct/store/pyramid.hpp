#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "reconstruct/geometry/cuboid.hpp"

namespace biotomy::reconstruct {

/// How many voxels of level 0 a voxel of a coarser level averages along each axis: powers of two.
struct LevelFactor {
  std::int64_t x = 1;
  std::int64_t y = 1;
  std::int64_t z = 1;

  friend bool operator==(const LevelFactor&, const LevelFactor&) = default;
};

/// One level of the pyramid in space. Voxel (i, j, k) is the mean of the voxels i·factor.x to
/// (i + 1)·factor.x − 1 of level 0 (likewise along y and z) as far as they exist, and has its
/// centre at origin + (i·spacing.x, j·spacing.y, k·spacing.z), in micrometres.
struct PyramidLevel {
  LevelFactor factor;
  GridSize size;    ///< level 0's divided by the factor, rounded up
  Vector3 spacing;  ///< level 0's times the factor
  Vector3 origin;   ///< (factor − 1)/2 voxels of level 0 along each axis
};

/// The finest spacing among the axes of more than one voxel, those that can still be halved;
/// infinite where there is none.
double finest_spacing(const PyramidLevel& level);

/// The level that `factor` makes of `finest`.
PyramidLevel pyramid_level(const Cuboid& finest, const LevelFactor& factor);

/// The factors of all levels, from level 0 on. Each level halves the axes whose voxels are finest,
/// up to √2 times the least, until the voxels are about cubic; then that is all three. An axis of
/// one voxel stays as it is. The last level is the first that fits into one chunk; `chunk` is in
/// the order z, y, x.
std::vector<LevelFactor> pyramid_factors(const Cuboid& finest, const std::array<int, 3>& chunk);

}  // namespace biotomy::reconstruct
