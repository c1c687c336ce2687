#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "reconstruct/bricks/brick_source.hpp"

namespace biotomy::reconstruct {

/// A brick of a level.
using BrickKey = std::pair<int, ChunkIndex>;

/// Bricks kept up to a number of bytes, the longest unused going first. A brick in use by a caller
/// stays alive whatever the cache does. Two threads that ask for the same brick fetch it once. Safe
/// for many threads.
class BrickCache {
 public:
  /// Gives the bricks of a level in the order of the indices; null for fill value.
  using Fetch = std::function<std::vector<TexelBrick>(int level, std::span<const ChunkIndex>)>;

  BrickCache(std::size_t capacity_bytes, std::size_t brick_bytes, Fetch fetch);
  ~BrickCache();

  std::size_t capacity_bytes() const;

  /// Those that are not there are fetched in one call. Throws what that throws; nothing of what it
  /// would have given is kept then.
  std::vector<TexelBrick> get(int level, std::span<const ChunkIndex> wanted);

  /// Those of `indices` that a get would have to fetch.
  std::vector<ChunkIndex> missing(int level, std::span<const ChunkIndex> indices) const;

  /// Takes those that `wanted` says yes to over from another cache, which keeps them too.
  void adopt(const BrickCache& other, const std::function<bool(const BrickKey&)>& wanted);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace biotomy::reconstruct
