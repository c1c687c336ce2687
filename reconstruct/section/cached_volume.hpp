#pragma once

#include <cstddef>

#include "reconstruct/section/chunk_source.hpp"
#include "reconstruct/store/chunk_cache.hpp"

namespace biotomy::reconstruct {

/// A volume read through a chunk cache. The volume must outlive it.
class CachedVolume final : public ChunkSource {
 public:
  CachedVolume(const Volume& volume, std::size_t capacity_bytes)
      : volume_(volume), cache_(volume, capacity_bytes) {}

  const Cuboid& cuboid() const override { return volume_.cuboid(); }
  std::array<int, 3> chunk_shape() const override { return volume_.layout().chunk; }
  int bits() const override { return volume_.bits(); }
  std::shared_ptr<const ChunkVoxels> chunk(ChunkIndex index) override { return cache_.get(index); }

 private:
  const Volume& volume_;
  ChunkCache cache_;
};

}  // namespace biotomy::reconstruct
