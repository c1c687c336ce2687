#pragma once

#include <cstddef>
#include <memory>

#include "reconstruct/store/volume.hpp"

namespace biotomy::reconstruct {

/// Decoded chunks of one volume, kept up to a number of bytes, the longest unused going first. A
/// chunk in use by a caller stays alive whatever the cache does. Two threads that ask for the same
/// chunk decode it once. Safe for many threads.
class ChunkCache {
 public:
  ChunkCache(const Volume& volume, std::size_t capacity_bytes);
  ~ChunkCache();

  /// Null where the volume has fill value. Throws what Volume::read_chunk throws.
  std::shared_ptr<const ChunkVoxels> get(ChunkIndex index);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace biotomy::reconstruct
