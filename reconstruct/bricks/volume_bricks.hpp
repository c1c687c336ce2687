#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "reconstruct/bricks/block_pool.hpp"
#include "reconstruct/bricks/brick_cache.hpp"
#include "reconstruct/bricks/brick_cells.hpp"
#include "reconstruct/bricks/brick_source.hpp"
#include "reconstruct/bricks/layer_tail.hpp"
#include "reconstruct/bricks/texel_blocks.hpp"
#include "reconstruct/store/volume.hpp"

namespace biotomy::reconstruct {

/// What is to be done with what can't be read.
struct DamagePolicy {
  bool tolerate = false;  ///< instead of throwing: fill the brick with `colour`, count it
  std::array<std::uint8_t, 3> colour{};  ///< red, green, blue of 8 bits
};

/// What was tolerated.
struct Damage {
  std::int64_t chunks = 0;  ///< each counted once, however often it was asked for
  std::string first;        ///< what was wrong with the first, by level and then by z, y, x
};

/// A volume read through a cache of decoded bricks, with the layers laid over it that are not in it
/// yet, if a tail is given. Of a chunk only the cells near the plane are decoded and laid out,
/// until a brick that is kept lacks what another plane needs: from then on all of it is, as planes
/// that follow each other need what lies beside them. Volume and tail must outlive it.
class VolumeBricks final : public BrickSource {
 public:
  VolumeBricks(const Volume& volume, std::size_t capacity_bytes, const DamagePolicy& policy = {},
               const LayerTail* tail = nullptr);

  /// Likewise, of a volume that was opened before and has grown since: what `before` has read of
  /// layers that were complete then is not read again.
  VolumeBricks(const Volume& volume, std::size_t capacity_bytes, const DamagePolicy& policy,
               const LayerTail* tail, const VolumeBricks& before);

  const Cuboid& cuboid() const override { return volume_.cuboid(); }
  int bits() const override { return volume_.bits(); }
  std::array<int, 3> brick_shape() const override { return volume_.layout().chunk; }
  int levels() const override { return volume_.levels(); }
  const PyramidLevel& level(int number) const override { return volume_.level(number); }
  std::int64_t layers_present() const override {
    return tail_ != nullptr ? tail_->layers_present() : volume_.layers_present();
  }
  std::size_t capacity_bytes() const override { return cache_.capacity_bytes(); }
  std::vector<TexelBrick> bricks(int level, std::span<const ChunkIndex> wanted,
                                 const PlaneReach& plane) override;
  void expect(int level, std::span<const ChunkIndex> soon, const PlaneReach& plane) override;

  Damage damage() const;

 private:
  VolumeBricks(const Volume& volume, std::size_t capacity_bytes, const DamagePolicy& policy,
               const LayerTail* tail, const BlockPool* pool);
  bool in_tail(int level, ChunkIndex index) const;
  bool is_complete(int level, ChunkIndex index) const;
  std::vector<BrickPart> parts(int level, std::span<const ChunkIndex> wanted,
                               const PlaneReach& plane) const;
  std::vector<KeptBrick> fetch(int level, std::span<const BrickFetch> wanted);
  KeptBrick brick_of(std::span<const std::byte> voxels, CellSet cells, const KeptBrick& kept);
  KeptBrick damaged_brick();
  void note_damage(int level, const ChunkIndex& chunk, const std::string& what);

  const Volume& volume_;
  DamagePolicy policy_;
  const LayerTail* tail_;
  TexelBlocks blocks_;
  BrickCells cells_;
  BlockPool pool_;
  BrickCache cache_;
  std::atomic<bool> several_planes_{false};
  mutable std::mutex mutex_;
  std::set<std::pair<int, ChunkIndex>> damaged_;
  std::string first_damage_;
};

}  // namespace biotomy::reconstruct
