#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "reconstruct/bricks/texel_blocks.hpp"

namespace biotomy::reconstruct {

/// Where each voxel of a stretch along one axis lies among the bricks of a box: its share in the
/// number of its brick (the slot), its texel within the brick, and the share of that in the texel's
/// place in memory. A table, so that no pixel needs a division. Voxels beyond the border of the
/// volume lie where the border's do.
class VoxelPlaces {
 public:
  struct Place {
    int slot = 0;
    int texel = 0;
    int offset = 0;  ///< bytes, as TexelBlocks says
  };

  VoxelPlaces() = default;

  /// Voxels `first` to `last` of axis `axis` (0, 1, 2: x, y, z), which has `size` voxels, in bricks
  /// of `side`; the box begins with brick `first_brick`, and `slot_stride` is from one brick's slot
  /// to the next one's.
  VoxelPlaces(const TexelBlocks& blocks, std::size_t axis, int first, int last, int size, int side,
              int first_brick, int slot_stride)
      : first_(first) {
    places_.reserve(static_cast<std::size_t>(last - first + 1));
    for (int voxel = first; voxel <= last; ++voxel) {
      const int inside = std::clamp(voxel, 0, size - 1);
      const int brick = inside / side;
      const int texel = inside - brick * side;
      places_.push_back({(brick - first_brick) * slot_stride, texel, blocks.along(axis, texel)});
    }
  }

  const Place& of(int voxel) const { return places_[static_cast<std::size_t>(voxel - first_)]; }

 private:
  int first_ = 0;
  std::vector<Place> places_;
};

}  // namespace biotomy::reconstruct
