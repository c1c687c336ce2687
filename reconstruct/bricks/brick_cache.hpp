#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "reconstruct/bricks/brick_cells.hpp"
#include "reconstruct/bricks/brick_source.hpp"
#include "reconstruct/bricks/partial_brick.hpp"

namespace biotomy::reconstruct {

/// A brick of a level.
using BrickKey = std::pair<int, ChunkIndex>;

/// A brick as it is kept; null for fill value.
using KeptBrick = std::shared_ptr<PartialBrick>;

/// Cells that are needed of a brick.
struct BrickPart {
  ChunkIndex index;
  CellSet cells = 0;
};

/// Cells that have to be fetched; into the brick that is kept already, if one is.
struct BrickFetch {
  BrickPart part;
  KeptBrick kept;
};

/// Bricks kept up to a number of bytes, the longest unused going first. A brick in use by a caller
/// stays alive whatever the cache does. Two threads that ask for the same brick fetch it once, but
/// for cells that the first did not ask for. Safe for many threads.
class BrickCache {
 public:
  /// Gives the bricks of a level in the order of what is wanted, with those cells at least.
  using Fetch = std::function<std::vector<KeptBrick>(int level, std::span<const BrickFetch>)>;

  BrickCache(std::size_t capacity_bytes, std::size_t brick_bytes, Fetch fetch);
  ~BrickCache();

  std::size_t capacity_bytes() const;

  /// Those that are not there are fetched in one call. Throws what that throws; nothing of what it
  /// would have given is kept then.
  std::vector<TexelBrick> get(int level, std::span<const BrickPart> wanted);

  /// Those of `wanted` that a get would have to fetch.
  std::vector<ChunkIndex> missing(int level, std::span<const BrickPart> wanted) const;

  /// Takes those that `wanted` says yes to over from another cache, which keeps them too.
  void adopt(const BrickCache& other, const std::function<bool(const BrickKey&)>& wanted);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace biotomy::reconstruct
