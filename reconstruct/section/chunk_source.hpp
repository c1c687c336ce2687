#pragma once

#include <array>
#include <memory>

#include "reconstruct/geometry/cuboid.hpp"
#include "reconstruct/store/volume.hpp"

namespace biotomy::reconstruct {

/// What the sampler reads: the voxels of one level of a volume, chunk by chunk. A file, a cache or
/// memory may stand behind it.
class ChunkSource {
 public:
  virtual ~ChunkSource() = default;

  virtual const Cuboid& cuboid() const = 0;
  virtual std::array<int, 3> chunk_shape() const = 0;  ///< in voxels, in the order z, y, x
  virtual int bits() const = 0;                        ///< of one colour, 8 or 16

  /// Null where the volume has fill value, 0. Safe for many threads.
  virtual std::shared_ptr<const ChunkVoxels> chunk(ChunkIndex index) = 0;
};

}  // namespace biotomy::reconstruct
