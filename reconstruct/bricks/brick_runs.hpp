#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "reconstruct/bricks/texel_kernels.hpp"

namespace biotomy::reconstruct {

/// A pixel of a run along one axis, for linear: its voxel and the one it is mixed with, as texels
/// of their bricks.
struct TexelPair {
  int near = 0;
  int far = 0;
  float part = 0.0F;  ///< the pixel's place between them, below 1
};

/// `bricks` are those of the pixel's run. Beyond the volume's border the border's colour goes on,
/// mixed with no other.
inline TexelPair texel_pair(const RowAxis& axis, const BrickPair& bricks, int pixel) {
  constexpr std::int32_t kUnit = 1 << kFractionBits;
  const std::int32_t position = axis.start + pixel * axis.step;
  const int voxel = axis.base + (position >> kFractionBits);
  const int inside = std::clamp(voxel, axis.first, axis.last);
  const bool mixes = voxel == inside && voxel < axis.last;
  return {inside - bricks.near * axis.side,
          inside + (mixes ? axis.next : 0) - bricks.far * axis.side,
          mixes ? static_cast<float>(position & (kUnit - 1)) / static_cast<float>(kUnit) : 0.0F};
}

/// Parts rows of pixels where the bricks change that their supports for linear lie in. So nothing
/// has to be looked up for a pixel: what is to be known of its bricks is known of its run.
class RunFinder {
 public:
  /// Adds the parts of a row of `count` pixels to `runs`.
  void find(const RowPath& path, int count, std::vector<BrickRun>& runs);

 private:
  /// Pixels that have the same bricks along one axis, from the end of the stretch before on.
  struct Stretch {
    int end = 0;
    BrickPair bricks;
    bool beyond_border = false;  // the voxel or the next
  };

  static void find_along(const RowAxis& axis, int count, std::vector<Stretch>& stretches);

  std::array<std::vector<Stretch>, 3> stretches_;  // x, y, z: working memory
};

}  // namespace biotomy::reconstruct
