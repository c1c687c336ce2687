#include "reconstruct/section/level_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace biotomy::reconstruct {
namespace {

constexpr double kLeastPart = 0.125;
constexpr double kLeastOctaves = 0.125;
constexpr double kSameSize = 1e-6;  // relative: a pixel that is meant to be a voxel is one

using Counts = std::array<bool, 3>;  // whether an axis does

Counts axes_of_several_voxels(const GridSize& size) {
  return {size.x > 1, size.y > 1, size.z > 1};
}

/// How far one goes in the plane, in the direction in which that is least, until a voxel is
/// crossed: one over the largest singular value of the map from micrometres along `axes` to voxels.
/// Infinite where no axis that counts runs along the plane.
double finest_in_plane(const Vector3& spacing, const SectionBasis& axes, const Counts& counts) {
  const auto in_voxels = [&](const Vector3& v) {
    return Vector3{counts[0] ? v.x / spacing.x : 0.0, counts[1] ? v.y / spacing.y : 0.0,
                   counts[2] ? v.z / spacing.z : 0.0};
  };
  const Vector3 p = in_voxels(axes.p);
  const Vector3 q = in_voxels(axes.q);
  const double middle = (dot(p, p) + dot(q, q)) / 2.0;
  const double apart = std::hypot((dot(p, p) - dot(q, q)) / 2.0, dot(p, q));
  return 1.0 / std::sqrt(middle + apart);
}

/// Along an axis of one voxel the pyramid does not go on and colours do not change: it does not
/// count, except where there is no other.
double voxel_size(const BrickSource& source, int number, const SectionBasis& axes) {
  const PyramidLevel& level = source.level(number);
  const double finest = finest_in_plane(level.spacing, axes, axes_of_several_voxels(level.size));
  return std::isfinite(finest)
             ? finest
             : finest_in_plane(level.spacing, axes, axes_of_several_voxels(source.level(0).size));
}

struct SizedLevel {
  int number = 0;
  double voxel = 0.0;  // in the plane, micrometres
};

double octaves(double from, double to) {
  return std::log2(to / from);
}

/// From the finest on, each coarser in the plane than the one before.
std::vector<SizedLevel> levels_in_plane(const BrickSource& source, const SectionBasis& axes) {
  std::vector<SizedLevel> levels{{0, voxel_size(source, 0, axes)}};
  for (int number = 1; number < source.levels(); ++number) {
    const double voxel = voxel_size(source, number, axes);
    if (octaves(levels.back().voxel, voxel) >= kLeastOctaves) {
      levels.push_back({number, voxel});
    }
  }
  return levels;
}

}  // namespace

LevelChoice level_choice(const BrickSource& source, const PixelGrid& grid, Interpolation kind) {
  const double pixel = grid.pixel;
  const std::vector<SizedLevel> levels = levels_in_plane(source, grid.rectangle.axes);
  const auto larger = std::find_if(levels.begin(), levels.end(), [&](const SizedLevel& level) {
    return level.voxel > pixel * (1.0 + kSameSize);
  });
  const SizedLevel finer = larger == levels.begin() ? levels.front() : *(larger - 1);
  const LevelChoice only_finer{finer.number, finer.number, 0.0};
  if (larger == levels.end() || pixel <= finer.voxel * (1.0 + kSameSize)) {
    return only_finer;
  }
  const double part = octaves(finer.voxel, pixel) / octaves(finer.voxel, larger->voxel);
  const double least = kind == Interpolation::nearest ? 0.5 : kLeastPart;
  if (part < least) {
    return only_finer;
  }
  if (part >= 1.0 - least) {
    return {larger->number, larger->number, 0.0};
  }
  return {finer.number, larger->number, part};
}

}  // namespace biotomy::reconstruct
