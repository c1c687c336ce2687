#include "reconstruct/store/pyramid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace biotomy::reconstruct {
namespace {

std::int64_t divide_up(std::int64_t size, std::int64_t factor) {
  return (size + factor - 1) / factor;
}

bool fits(const GridSize& size, const std::array<int, 3>& chunk) {
  return size.x <= chunk[2] && size.y <= chunk[1] && size.z <= chunk[0];
}

}  // namespace

double finest_spacing(const PyramidLevel& level) {
  double finest = std::numeric_limits<double>::infinity();
  for (const auto& [size, spacing] :
       {std::pair(level.size.x, level.spacing.x), std::pair(level.size.y, level.spacing.y),
        std::pair(level.size.z, level.spacing.z)}) {
    if (size > 1) {
      finest = std::min(finest, spacing);
    }
  }
  return finest;
}

PyramidLevel pyramid_level(const Cuboid& finest, const LevelFactor& factor) {
  const auto along = [](std::int64_t times, double spacing) {
    return static_cast<double>(times) * spacing;
  };
  const auto first_centre = [](std::int64_t times, double spacing) {
    return static_cast<double>(times - 1) / 2.0 * spacing;
  };
  return {factor,
          {divide_up(finest.size.x, factor.x), divide_up(finest.size.y, factor.y),
           divide_up(finest.size.z, factor.z)},
          {along(factor.x, finest.spacing.x), along(factor.y, finest.spacing.y),
           along(factor.z, finest.spacing.z)},
          {first_centre(factor.x, finest.spacing.x), first_centre(factor.y, finest.spacing.y),
           first_centre(factor.z, finest.spacing.z)}};
}

std::vector<LevelFactor> pyramid_factors(const Cuboid& finest, const std::array<int, 3>& chunk) {
  std::vector<LevelFactor> factors{{}};
  for (;;) {
    const PyramidLevel level = pyramid_level(finest, factors.back());
    if (fits(level.size, chunk)) {
      return factors;
    }
    const double limit = std::sqrt(2.0) * finest_spacing(level);
    const auto next = [&](std::int64_t factor, std::int64_t size, double spacing) {
      return size > 1 && spacing <= limit ? 2 * factor : factor;
    };
    factors.push_back({next(level.factor.x, level.size.x, level.spacing.x),
                       next(level.factor.y, level.size.y, level.spacing.y),
                       next(level.factor.z, level.size.z, level.spacing.z)});
  }
}

}  // namespace biotomy::reconstruct
