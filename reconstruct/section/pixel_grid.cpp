#include "reconstruct/section/pixel_grid.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr double kWholePixel = 1e-6;    // of a pixel: a width of 99.9999999 pixels holds 100
constexpr double kSameCentre = 1e-9;    // of a voxel
constexpr double kMaxSidePixels = 1e9;  // so that counts are ints

double pixels_along(double length, double pixel) {
  return std::floor(length / pixel + kWholePixel) + 1.0;
}

}  // namespace

PixelGrid pixel_grid(const ThetaRectangle& rectangle, double pixel, int bytes_per_pixel,
                     std::int64_t max_bytes) {
  if (!std::isfinite(pixel) || pixel <= 0.0) {
    throw InvalidRequest("the pixel size must be a length above 0");
  }
  const double columns = pixels_along(rectangle.width, pixel);
  const double rows = pixels_along(rectangle.height, pixel);
  const double bytes = columns * rows * bytes_per_pixel;
  if (bytes > static_cast<double>(max_bytes) || columns > kMaxSidePixels || rows > kMaxSidePixels) {
    std::ostringstream message;
    message << "a pixel of " << pixel << " um makes a picture of " << columns << " x " << rows
            << " pixels, " << bytes / 1e9 << " GB; the limit is "
            << static_cast<double>(max_bytes) / 1e9 << " GB: ask for a larger pixel";
    throw SampleError(message.str());
  }
  return {rectangle, pixel, static_cast<int>(columns), static_cast<int>(rows)};
}

PixelGrid shifted_grid(const PixelGrid& grid, double columns, double rows) {
  const double right = columns * grid.pixel;
  const double down = rows * grid.pixel;
  ThetaRectangle rectangle = grid.rectangle;
  rectangle.origin = rectangle.origin + right * rectangle.axes.p + down * rectangle.axes.q;
  rectangle.width = std::max(rectangle.width - right, 0.0);
  rectangle.height = std::max(rectangle.height - down, 0.0);
  return {rectangle, grid.pixel, static_cast<int>(pixels_along(rectangle.width, grid.pixel)),
          static_cast<int>(pixels_along(rectangle.height, grid.pixel))};
}

VoxelRow voxel_row(const PixelGrid& grid, const PyramidLevel& level, int row) {
  const ThetaRectangle& rectangle = grid.rectangle;
  const Vector3 start = rectangle.origin + (row * grid.pixel) * rectangle.axes.q - level.origin;
  const Vector3 step = grid.pixel * rectangle.axes.p;
  const Vector3 down = grid.pixel * rectangle.axes.q;
  VoxelRow result{{start.x / level.spacing.x, start.y / level.spacing.y, start.z / level.spacing.z},
                  {step.x / level.spacing.x, step.y / level.spacing.y, step.z / level.spacing.z}};
  const std::array<double, 3> row_step{down.x / level.spacing.x, down.y / level.spacing.y,
                                       down.z / level.spacing.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.forgiven[axis] += kWholePixel * (std::abs(result.step[axis]) + std::abs(row_step[axis]));
    const double centre = std::round(result.start[axis]);
    const double whole_step = std::round(result.step[axis]);
    if (std::abs(result.start[axis] - centre) < kSameCentre &&
        std::abs(result.step[axis] - whole_step) * grid.columns < kSameCentre) {
      result.start[axis] = centre;
      result.step[axis] = whole_step;
    }
  }
  return result;
}

VoxelRow voxel_row(const PixelGrid& grid, const Cuboid& cuboid, int row) {
  return voxel_row(grid, pyramid_level(cuboid, {}), row);
}

ColumnRange columns_inside(const VoxelRow& row, ColumnRange range, const GridSize& size) {
  const std::array<std::int64_t, 3> sizes{size.x, size.y, size.z};
  double first = range.first;
  double last = range.last - 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double lowest = -row.forgiven[axis] - row.start[axis];
    const double highest =
        static_cast<double>(sizes[axis] - 1) + row.forgiven[axis] - row.start[axis];
    if (row.step[axis] == 0.0) {
      if (lowest > 0.0 || highest < 0.0) {
        return {range.first, range.first};
      }
      continue;
    }
    const double a = lowest / row.step[axis];
    const double b = highest / row.step[axis];
    first = std::max(first, std::ceil(std::min(a, b)));
    last = std::min(last, std::floor(std::max(a, b)));
  }
  if (first > last) {
    return {range.first, range.first};
  }
  return {static_cast<int>(first), static_cast<int>(last) + 1};
}

}  // namespace biotomy::reconstruct
