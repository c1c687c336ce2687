#pragma once

#include <cstddef>
#include <vector>

#include "reconstruct/store/shard.hpp"

namespace biotomy::reconstruct {

/// The bytes of a shard's file.
inline std::vector<std::byte> whole_shard(const std::vector<std::vector<std::byte>>& chunks) {
  std::vector<std::byte> shard;
  for (const std::vector<std::byte>& chunk : chunks) {
    shard.insert(shard.end(), chunk.begin(), chunk.end());
  }
  const std::vector<std::byte> index = encode_shard_index(chunks);
  shard.insert(shard.end(), index.begin(), index.end());
  return shard;
}

}  // namespace biotomy::reconstruct
