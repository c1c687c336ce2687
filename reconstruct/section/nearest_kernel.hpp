#pragma once

// Nearest voxel. Radius 1/2 voxel, support 1 voxel, order 0 (the colours are those of the volume,
// not continuous). A point half-way between two voxels takes the farther from the origin.
// Edges: a coordinate outside the volume (by rounding) is moved to its border.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "reconstruct/section/chunk_window.hpp"
#include "reconstruct/section/pixel_grid.hpp"

namespace biotomy::reconstruct {

/// `Level` is std::uint8_t or std::uint16_t.
template <typename Level>
struct NearestKernel {
  /// Writes R G B of the columns of `range` to `out`, all of them inside the volume of `last` + 1
  /// voxels along x, y, z.
  static void sample_row(const VoxelRow& row, ColumnRange range, const std::array<int, 3>& last,
                         ChunkWindow& window, Level* out) {
    const std::array<int, 3>& shape = window.chunk_shape();
    for (int column = range.first; column < range.last; ++column, out += 3) {
      std::array<int, 3> chunk{};
      std::array<int, 3> local{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double at = row.start[axis] + column * row.step[axis];
        const int voxel = std::clamp(static_cast<int>(at + 0.5), 0, last[axis]);
        chunk[axis] = voxel / shape[axis];
        local[axis] = voxel - chunk[axis] * shape[axis];
      }
      const auto* voxels = reinterpret_cast<const Level*>(window.chunk(chunk));
      const std::ptrdiff_t place =
          (static_cast<std::ptrdiff_t>(local[2]) * shape[1] + local[1]) * shape[0] + local[0];
      std::copy_n(voxels + 3 * place, 3, out);
    }
  }
};

}  // namespace biotomy::reconstruct
