#pragma once

#include <cstdint>
#include <string>

#include "reconstruct/geometry/cuboid.hpp"
#include "reconstruct/store/volume.hpp"

namespace biotomy::reconstruct {

/// Voxels of a level: along each axis from `first` to before `end`.
struct VoxelRange {
  std::int64_t first = 0;
  std::int64_t end = 0;

  std::int64_t count() const { return end - first; }
  friend bool operator==(const VoxelRange&, const VoxelRange&) = default;
};
struct VoxelRegion {
  VoxelRange x;
  VoxelRange y;
  VoxelRange z;

  GridSize size() const { return {x.count(), y.count(), z.count()}; }
  friend bool operator==(const VoxelRegion&, const VoxelRegion&) = default;
};

/// Understands `x0:x1,y0:y1,z0:z1`: from x0 to before x1; a number left out is the border. `whole`
/// is what there is. Throws InvalidRequest that names what cannot be, and SampleError when the
/// region is not within `whole`.
VoxelRegion parse_region(const std::string& text, const VoxelRegion& whole);

/// All of a level, as deep as `layers` of level 0 have a part in it.
VoxelRegion whole_level(const Volume& volume, int level, std::int64_t layers);

/// The voxels of level `coarser` that a region of level `finer` has a part in.
VoxelRegion region_of_level(const VoxelRegion& region, const PyramidLevel& finer,
                            const PyramidLevel& coarser);

}  // namespace biotomy::reconstruct
