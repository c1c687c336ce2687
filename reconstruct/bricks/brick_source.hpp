#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "reconstruct/bricks/brick_cells.hpp"
#include "reconstruct/geometry/cuboid.hpp"
#include "reconstruct/store/pyramid.hpp"
#include "reconstruct/store/volume.hpp"

namespace biotomy::reconstruct {

/// A decoded chunk as the kernels read it: laid out as TexelBlocks says, with its slack behind it.
/// Null stands for a brick of fill value, 0.
using TexelBrick = std::shared_ptr<const std::byte>;

/// What the sampler reads: the levels of a volume, brick by brick. A file, a cache or memory may
/// stand behind it. Safe for many threads.
class BrickSource {
 public:
  virtual ~BrickSource() = default;

  virtual const Cuboid& cuboid() const = 0;            ///< of level 0
  virtual int bits() const = 0;                        ///< of one colour, 8 or 16
  virtual std::array<int, 3> brick_shape() const = 0;  ///< in voxels, in the order z, y, x
  virtual int levels() const = 0;                      ///< at least 1
  virtual const PyramidLevel& level(int number) const = 0;

  /// Layers of level 0, from the first on, that hold colours; those behind them are fill value. A
  /// voxel of a coarser level is the mean of those of its layers that are present.
  virtual std::int64_t layers_present() const = 0;

  /// How many bytes of bricks may be held: who needs more at once asks for them in parts.
  virtual std::size_t capacity_bytes() const = 0;

  /// The bricks of `wanted`, in its order. What has to be fetched is fetched together. Their texels
  /// that lie near the plane are those of the level; others may mean nothing. `wanted` has no brick
  /// twice; all are of the level. Throws SampleError.
  virtual std::vector<TexelBrick> bricks(int level, std::span<const ChunkIndex> wanted,
                                         const PlaneReach& plane) = 0;

  /// These will be asked for soon: whoever can may begin to read them. Does not wait for them.
  virtual void expect(int level, std::span<const ChunkIndex> soon, const PlaneReach& plane) = 0;
};

}  // namespace biotomy::reconstruct
