#include "reconstruct/section/level_choice.hpp"

#include <algorithm>
#include <cmath>

namespace biotomy::reconstruct {
namespace {

constexpr double kSameSize = 1e-6;  // relative: a pixel that is meant to be a voxel is one

double finest_spacing(const PyramidLevel& level) {
  return std::min({level.spacing.x, level.spacing.y, level.spacing.z});
}

}  // namespace

LevelChoice level_choice(const BrickSource& source, double pixel, Interpolation kind) {
  int finer = 0;
  while (finer + 1 < source.levels() &&
         finest_spacing(source.level(finer + 1)) <= pixel * (1.0 + kSameSize)) {
    ++finer;
  }
  const double at_finer = finest_spacing(source.level(finer));
  if (finer + 1 == source.levels() || pixel <= at_finer * (1.0 + kSameSize)) {
    return {finer, 0.0};
  }
  const double part =
      std::log(pixel / at_finer) / std::log(finest_spacing(source.level(finer + 1)) / at_finer);
  if (kind == Interpolation::nearest) {
    return {part < 0.5 ? finer : finer + 1, 0.0};
  }
  return {finer, part};
}

}  // namespace biotomy::reconstruct
