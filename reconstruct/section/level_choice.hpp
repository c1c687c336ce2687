#pragma once

#include "reconstruct/bricks/brick_source.hpp"
#include "reconstruct/section/interpolation.hpp"

namespace biotomy::reconstruct {

/// Which levels of a pyramid a picture is sampled from. A colour is (1 − part) times that of level
/// `finer` and `part` times that of level finer + 1; a part of 0 needs one level alone.
struct LevelChoice {
  int finer = 0;
  double part = 0.0;

  friend bool operator==(const LevelChoice&, const LevelChoice&) = default;
};

/// The choice for pixels of a size in micrometres. A pixel up to the size of a voxel is sampled
/// from level 0. A larger one would leave voxels out, so that fine structure turns into moiré; it
/// is taken from the levels whose finest spacing is next below and next above it, mixed by the
/// logarithm of the size between them, which is the filter between levels of a mipmap (Williams
/// 1983). A level whose part would be below an eighth is left out: it would cost as much reading as
/// the other, or several times as much, and hardly be seen. `nearest` takes the one that is nearer.
/// Axes of one voxel do not count.
LevelChoice level_choice(const BrickSource& source, double pixel, Interpolation kind);

}  // namespace biotomy::reconstruct
