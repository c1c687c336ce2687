#include "reconstruct/section/level_choice.hpp"

#include <algorithm>
#include <cmath>

namespace biotomy::reconstruct {
namespace {

constexpr double kLeastPart = 0.125;
constexpr double kSameSize = 1e-6;  // relative: a pixel that is meant to be a voxel is one

/// Along an axis of one voxel the pyramid does not go on and colours do not change: it does not
/// count, except where there is no other.
double voxel_size(const PyramidLevel& level) {
  const double finest = finest_spacing(level);
  return std::isfinite(finest) ? finest
                               : std::max({level.spacing.x, level.spacing.y, level.spacing.z});
}

}  // namespace

LevelChoice level_choice(const BrickSource& source, double pixel, Interpolation kind) {
  int finer = 0;
  while (finer + 1 < source.levels() &&
         voxel_size(source.level(finer + 1)) <= pixel * (1.0 + kSameSize)) {
    ++finer;
  }
  const double at_finer = voxel_size(source.level(finer));
  if (finer + 1 == source.levels() || pixel <= at_finer * (1.0 + kSameSize)) {
    return {finer, 0.0};
  }
  const double part =
      std::log(pixel / at_finer) / std::log(voxel_size(source.level(finer + 1)) / at_finer);
  const double least = kind == Interpolation::nearest ? 0.5 : kLeastPart;
  if (part < least) {
    return {finer, 0.0};
  }
  if (part >= 1.0 - least) {
    return {finer + 1, 0.0};
  }
  return {finer, part};
}

}  // namespace biotomy::reconstruct
