#pragma once

#include <array>
#include <cstdint>

#include "reconstruct/geometry/cuboid.hpp"
#include "reconstruct/geometry/theta_rectangle.hpp"
#include "reconstruct/store/pyramid.hpp"

namespace biotomy::reconstruct {

/// The pixels of a section in the rectangle that they fill: the centre of pixel (u, v) lies at
/// origin + u·pixel·p + v·pixel·q.
struct PixelGrid {
  ThetaRectangle rectangle;
  double pixel = 0.0;  ///< micrometres
  int columns = 0;     ///< floor(width / pixel + 10⁻⁶) + 1
  int rows = 0;        ///< floor(height / pixel + 10⁻⁶) + 1
};

/// Throws InvalidRequest for a pixel size that is not a number above zero, SampleError when the
/// picture would take more than `max_bytes` at `bytes_per_pixel`.
PixelGrid pixel_grid(const ThetaRectangle& rectangle, double pixel, int bytes_per_pixel,
                     std::int64_t max_bytes);

/// The grid whose first pixel lies further on by `columns` and `rows` of a pixel, both from 0 to
/// below 1, in what is left of the rectangle: which must hold a pixel there.
PixelGrid shifted_grid(const PixelGrid& grid, double columns, double rows);

/// A row of pixel centres in voxel coordinates, in the order x, y, z: the centre of column u lies
/// at start + u·step. Each coordinate is computed from u in double precision, so that nothing adds
/// up along a row: at column 20 000 the error is below 10⁻¹¹ voxel.
struct VoxelRow {
  std::array<double, 3> start{};
  std::array<double, 3> step{};
  /// How far outside the cuboid a centre may lie that still counts as in it: 10⁻⁶ voxel, and what
  /// pixel_grid forgives of a pixel along the picture's two sides.
  std::array<double, 3> forgiven{1e-6, 1e-6, 1e-6};

  double at(int axis, int column) const {
    return start[static_cast<std::size_t>(axis)] + column * step[static_cast<std::size_t>(axis)];
  }
};

/// Row `row` of `grid` among the voxels of `cuboid`. An axis along which all pixels of the row lie
/// on voxel centres, to within 10⁻⁹ voxel, has exactly those: start and step are whole numbers. So
/// a section along a layer needs no other layer, and no voxel beside its own.
VoxelRow voxel_row(const PixelGrid& grid, const Cuboid& cuboid, int row);

/// Likewise among the voxels of a level of the pyramid.
VoxelRow voxel_row(const PixelGrid& grid, const PyramidLevel& level, int row);

/// Columns from `first` to before `last`.
struct ColumnRange {
  int first = 0;
  int last = 0;
};

/// The columns of `range` whose centres lie in the cuboid, or outside by no more than is forgiven.
ColumnRange columns_inside(const VoxelRow& row, ColumnRange range, const GridSize& size);

}  // namespace biotomy::reconstruct
