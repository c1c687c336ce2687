#pragma once

#include <algorithm>
#include <cstdint>
#include <random>

#include "reconstruct/bricks/texel_kernels.hpp"

namespace biotomy::reconstruct::tests {

/// A row somewhere in a box of bricks, or partly beside it; steps may be 0, go back, or step over
/// bricks. Along some axes all pixels lie on voxel centres.
inline RowPath random_path(int count, std::mt19937& random) {
  constexpr std::int32_t kVoxel = 1 << kFractionBits;
  RowPath path;
  path.block_row_bytes = 64 * (1 + static_cast<int>(random() % 9));
  path.layer_bytes = path.block_row_bytes * (1 + static_cast<int>(random() % 9));
  int slot_stride = 1;
  for (RowAxis& axis : path.axes) {
    axis.side = random() % 2 == 0 ? 1 << random() % 6 : 1 + static_cast<int>(random() % 40);
    axis.first = -static_cast<int>(random() % 3) * axis.side;
    axis.last = axis.first + static_cast<int>(random() % 600);
    axis.first = std::max(axis.first, 0);
    axis.last = std::max(axis.last, axis.first);
    axis.base = static_cast<int>(random() % static_cast<unsigned>(axis.last + 10)) - 5;
    const std::uint32_t reach = (random() % 4 == 0 ? kMostVoxels : 50) * std::uint32_t{kVoxel};
    axis.start = static_cast<std::int32_t>(random() % reach);
    const auto to = static_cast<std::int32_t>(random() % reach);
    axis.step = random() % 4 == 0 ? 0 : (to - axis.start) / std::max(count, 1);
    if (random() % 4 == 0) {
      axis.next = 0;
      axis.start = axis.start / kVoxel * kVoxel;
      axis.step = axis.step / kVoxel * kVoxel;
    }
    axis.slot_stride = slot_stride;
    slot_stride *= axis.last / axis.side + 1;
  }
  return path;
}

}  // namespace biotomy::reconstruct::tests
