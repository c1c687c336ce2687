#pragma once

// Trilinear. Radius 1 voxel, support 2 voxels along each axis, order 1 (continuous). Fractions are
// taken in double precision, the mean in float, the result rounded to the nearest level, so that it
// is within 1 level of exact arithmetic, and is the voxel's own colour at a voxel's centre.
// Edges: a coordinate outside the volume (by rounding) is moved to its border; a row whose
// coordinate is exactly a voxel's all along reads no neighbour along that axis.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "reconstruct/section/chunk_window.hpp"
#include "reconstruct/section/pixel_grid.hpp"

namespace biotomy::reconstruct {

/// `Level` is std::uint8_t or std::uint16_t.
template <typename Level>
class LinearKernel {
 public:
  /// Writes R G B of the columns of `range` to `out`, all of them inside the volume of `last` + 1
  /// voxels along x, y, z.
  static void sample_row(const VoxelRow& row, ColumnRange range, const std::array<int, 3>& last,
                         ChunkWindow& window, Level* out) {
    LinearKernel kernel(row, last, window);
    for (int column = range.first; column < range.last; ++column, out += 3) {
      kernel.sample(column, out);
    }
  }

 private:
  using Corners = std::array<const Level*, 8>;  // bit 0 of the number: +1 along x, 1: y, 2: z

  LinearKernel(const VoxelRow& row, const std::array<int, 3>& last, ChunkWindow& window)
      : row_(row),
        last_(last),
        window_(window),
        shape_(window.chunk_shape()),
        one_layer_(row.step[2] == 0.0) {
    std::ptrdiff_t stride = 3;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool on_centres =
          row.step[axis] == 0.0 &&
          row.start[axis] == static_cast<double>(static_cast<int>(row.start[axis]));
      neighbour_[axis] = on_centres ? 0 : 1;
      inner_[axis] = static_cast<unsigned>(shape_[axis] - neighbour_[axis]);
      stride_[axis] = stride;
      stride *= shape_[axis];
    }
    if (one_layer_ && row.start[2] < static_cast<double>(last[2])) {
      inner_[2] = static_cast<unsigned>(shape_[2]);
    }
    for (unsigned corner = 0; corner < 4; ++corner) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        corner_offset_[corner] +=
            ((corner >> axis) & 1U) != 0 ? neighbour_[axis] * stride_[axis] : 0;
      }
    }
  }

  void sample(int column, Level* out) {
    std::array<int, 3> voxel;
    std::array<float, 3> part;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double at = std::clamp(row_.start[axis] + column * row_.step[axis], 0.0,
                                   static_cast<double>(last_[axis]));
      voxel[axis] = static_cast<int>(at);
      part[axis] = static_cast<float>(at - voxel[axis]);
    }
    if (!inside_chunk(voxel)) {
      move_to_chunk_of(voxel);
      if (!inside_chunk(voxel)) {
        mix(corners_across_chunks(voxel), part, out);
        return;
      }
    }
    const std::ptrdiff_t place = (voxel[0] - origin_[0]) * stride_[0] +
                                 (voxel[1] - origin_[1]) * stride_[1] +
                                 (voxel[2] - origin_[2]) * stride_[2];
    Corners corners;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      corners[corner] = voxels_ + (place + corner_offset_[corner]);
      corners[corner + 4] = below_ + (place + below_shift_ + corner_offset_[corner]);
    }
    mix(corners, part, out);
  }

  // Whether the present chunk holds the voxel and its neighbours (those below it may be in the
  // chunk below). Before the chunk's origin the difference wraps round to a large number.
  bool inside_chunk(const std::array<int, 3>& voxel) const {
    return voxels_ != nullptr && static_cast<unsigned>(voxel[0] - origin_[0]) < inner_[0] &&
           static_cast<unsigned>(voxel[1] - origin_[1]) < inner_[1] &&
           static_cast<unsigned>(voxel[2] - origin_[2]) < inner_[2];
  }

  void move_to_chunk_of(const std::array<int, 3>& voxel) {
    std::array<int, 3> chunk;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      chunk[axis] = voxel[axis] / shape_[axis];
      origin_[axis] = chunk[axis] * shape_[axis];
    }
    voxels_ = reinterpret_cast<const Level*>(window_.chunk(chunk));
    below_ = voxels_;
    below_shift_ = neighbour_[2] * stride_[2];
    const int local_z = voxel[2] - origin_[2];
    if (!one_layer_ || local_z + neighbour_[2] < shape_[2]) {
      return;
    }
    if (voxel[2] == last_[2]) {
      below_shift_ = 0;
      return;
    }
    ++chunk[2];
    below_ = reinterpret_cast<const Level*>(window_.chunk(chunk));
    below_shift_ = -local_z * stride_[2];
  }

  Corners corners_across_chunks(const std::array<int, 3>& voxel) {
    Corners corners;
    for (unsigned corner = 0; corner < 8; ++corner) {
      std::array<int, 3> chunk;
      std::ptrdiff_t place = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int further = ((corner >> axis) & 1U) != 0 ? neighbour_[axis] : 0;
        const int at = std::min(voxel[axis] + further, last_[axis]);
        chunk[axis] = at / shape_[axis];
        place += (at - chunk[axis] * shape_[axis]) * stride_[axis];
      }
      corners[corner] = reinterpret_cast<const Level*>(window_.chunk(chunk)) + place;
    }
    return corners;
  }

  static void mix(const Corners& corners, const std::array<float, 3>& part, Level* out) {
    const float x1 = part[0];
    const float x0 = 1.0F - x1;
    const float y1 = part[1];
    const float y0 = 1.0F - y1;
    const float z1 = part[2];
    const float z0 = 1.0F - z1;
    const std::array<float, 8> weights{x0 * y0 * z0, x1 * y0 * z0, x0 * y1 * z0, x1 * y1 * z0,
                                       x0 * y0 * z1, x1 * y0 * z1, x0 * y1 * z1, x1 * y1 * z1};
    for (std::size_t colour = 0; colour < 3; ++colour) {
      float sum = 0.5F;
      for (std::size_t corner = 0; corner < 8; ++corner) {
        sum += weights[corner] * static_cast<float>(corners[corner][colour]);
      }
      out[colour] = static_cast<Level>(sum);
    }
  }

  const VoxelRow& row_;
  const std::array<int, 3>& last_;
  ChunkWindow& window_;
  const std::array<int, 3>& shape_;
  std::array<std::ptrdiff_t, 3> stride_{};         // in levels
  std::array<std::ptrdiff_t, 4> corner_offset_{};  // of the corners in the voxel's own layer
  std::array<int, 3> neighbour_{};   // 1, or 0 where the row lies on voxel centres along this axis
  std::array<unsigned, 3> inner_{};  // voxels of a chunk whose neighbours are in it too
  bool one_layer_;                   // the row stays between two layers, as in the basis `layer`
  const Level* voxels_ = nullptr;    // of the present chunk
  const Level* below_ = nullptr;     // of the chunk that holds the next layer: the same, or below
  std::ptrdiff_t below_shift_ = 0;   // from a voxel's place in the one to that below it
  std::array<int, 3> origin_{};      // of the present chunk
};

}  // namespace biotomy::reconstruct
