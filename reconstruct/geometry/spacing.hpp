#pragma once

#include <cmath>

namespace biotomy::reconstruct {

/// Whether a distance between voxel centres, in micrometres, can be meant: 1 pm to 1 km. Within
/// these limits no extent, area or squared distance of a sample leaves the range of a double.
inline bool is_spacing(double um) {
  constexpr double kLeast = 1e-6;
  constexpr double kMost = 1e9;
  return std::isfinite(um) && um >= kLeast && um <= kMost;
}

}  // namespace biotomy::reconstruct
