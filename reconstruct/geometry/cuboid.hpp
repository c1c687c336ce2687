#pragma once

#include <cstdint>

#include "reconstruct/geometry/vector3.hpp"

namespace biotomy::reconstruct {

/// Numbers of voxels along x, y and z.
struct GridSize {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t z = 0;

  friend bool operator==(const GridSize&, const GridSize&) = default;
};

/// The voxels of a sample in space: voxel (i, j, k) has its centre at (i·spacing.x, j·spacing.y,
/// k·spacing.z). Colour is defined in the closed box from (0, 0, 0) to `extent()`; outside is
/// background. Spacings are in micrometres, independent of each other, and above 0.
struct Cuboid {
  GridSize size;
  Vector3 spacing;

  Vector3 extent() const {
    return {static_cast<double>(size.x - 1) * spacing.x,
            static_cast<double>(size.y - 1) * spacing.y,
            static_cast<double>(size.z - 1) * spacing.z};
  }
};

}  // namespace biotomy::reconstruct
