#pragma once

#include <vector>

#include "reconstruct/bricks/brick_source.hpp"
#include "reconstruct/section/interpolation.hpp"
#include "reconstruct/section/pixel_grid.hpp"

namespace biotomy::reconstruct {

/// Which levels of a pyramid a picture is sampled from. A colour is (1 − part) times that of level
/// `finer` and `part` times that of level `coarser`; a part of 0 needs one level alone.
struct LevelChoice {
  int finer = 0;
  int coarser = 0;
  double part = 0.0;

  std::vector<int> levels() const {
    return part == 0.0 ? std::vector{finer} : std::vector{finer, coarser};
  }

  friend bool operator==(const LevelChoice&, const LevelChoice&) = default;
};

/// The choice for the pixels of a picture, by the finest spacing that voxels have in its plane. A
/// pixel up to that of level 0 is sampled from level 0. A larger one would leave voxels out, so
/// that fine structure turns into moiré; it is taken from the levels whose spacing in the plane is
/// next below and next above it, mixed by the logarithm of the size between them, which is the
/// filter between levels of a mipmap (Williams 1983). A level that is coarser across the plane
/// alone, or by less than an eighth of an octave in it, is passed over: it would mix layers, and
/// spare no pixel from moiré. A level whose part would be below an eighth is left out: it would
/// cost as much reading as the other, or several times as much, and hardly be seen. `nearest` takes
/// the one that is nearer. Axes of one voxel do not count.
LevelChoice level_choice(const BrickSource& source, const PixelGrid& grid, Interpolation kind);

}  // namespace biotomy::reconstruct
