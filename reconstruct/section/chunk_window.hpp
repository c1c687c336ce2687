#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <vector>

#include "reconstruct/section/chunk_source.hpp"

namespace biotomy::reconstruct {

/// A box of voxels, both ends included, in the order x, y, z.
struct VoxelBox {
  std::array<int, 3> first;
  std::array<int, 3> last;
};

/// The chunks that hold a box of voxels, each fetched from the source when it is first asked for
/// and then found by its place in a small table: no lock and no hash for a voxel. For one thread.
class ChunkWindow {
 public:
  /// `box` lies inside the volume.
  ChunkWindow(ChunkSource& source, const VoxelBox& box);

  /// In the order x, y, z.
  const std::array<int, 3>& chunk_shape() const { return shape_; }

  /// The voxels of the chunk at `chunk` (voxel coordinates divided by chunk_shape()), which
  /// holds a voxel of the box; x advances fastest, colours side by side.
  const std::byte* chunk(const std::array<int, 3>& chunk) {
    const std::size_t slot =
        (static_cast<std::size_t>(chunk[2] - first_[2]) * static_cast<std::size_t>(count_[1]) +
         static_cast<std::size_t>(chunk[1] - first_[1])) *
            static_cast<std::size_t>(count_[0]) +
        static_cast<std::size_t>(chunk[0] - first_[0]);
    const std::byte* voxels = voxels_[slot];
    return voxels != nullptr ? voxels : fetch(chunk, slot);
  }

  /// Those that were asked for.
  const std::vector<ChunkIndex>& touched() const { return touched_; }
  std::chrono::nanoseconds time_fetching() const { return time_fetching_; }

 private:
  const std::byte* fetch(const std::array<int, 3>& chunk, std::size_t slot);

  ChunkSource& source_;
  std::array<int, 3> shape_;
  std::array<int, 3> first_;
  std::array<int, 3> count_;
  std::size_t chunk_bytes_;
  std::vector<const std::byte*> voxels_;
  std::vector<std::shared_ptr<const ChunkVoxels>> held_;
  std::vector<ChunkIndex> touched_;
  std::unique_ptr<ChunkVoxels> fill_;
  std::chrono::nanoseconds time_fetching_{0};
};

}  // namespace biotomy::reconstruct
