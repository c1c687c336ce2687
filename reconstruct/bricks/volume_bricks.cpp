#include "reconstruct/bricks/volume_bricks.hpp"

#include <algorithm>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

template <typename Level>
std::vector<std::byte> painted(std::size_t voxels, const std::array<std::uint8_t, 3>& colour) {
  constexpr int kScale = sizeof(Level) == 1 ? 1 : 257;
  std::vector<std::byte> bytes(voxels * colour.size() * sizeof(Level));
  auto* level = reinterpret_cast<Level*>(bytes.data());
  for (std::size_t i = 0; i < voxels * colour.size(); ++i) {
    level[i] = static_cast<Level>(colour[i % colour.size()] * kScale);
  }
  return bytes;
}

std::size_t voxels_of(const VolumeLayout& layout) {
  return static_cast<std::size_t>(layout.chunk[0]) * static_cast<std::size_t>(layout.chunk[1]) *
         static_cast<std::size_t>(layout.chunk[2]);
}

/// Some of the chunks asked for.
struct Part {
  std::vector<ChunkIndex> chunks;
  std::vector<ChunkLayers> layers;
  std::vector<std::size_t> places;  // in the order asked for

  void add(ChunkIndex chunk, ChunkLayers needed, std::size_t place) {
    chunks.push_back(chunk);
    layers.push_back(needed);
    places.push_back(place);
  }
};

}  // namespace

VolumeBricks::VolumeBricks(const Volume& volume, std::size_t capacity_bytes,
                           const DamagePolicy& policy, const LayerTail* tail)
    : VolumeBricks(volume, capacity_bytes, policy, tail, static_cast<const BlockPool*>(nullptr)) {}

VolumeBricks::VolumeBricks(const Volume& volume, std::size_t capacity_bytes,
                           const DamagePolicy& policy, const LayerTail* tail,
                           const VolumeBricks& before)
    : VolumeBricks(volume, capacity_bytes, policy, tail, &before.pool_) {
  const bool same = volume.cuboid().size == before.volume_.cuboid().size &&
                    volume.bits() == before.volume_.bits() &&
                    volume.layout().chunk == before.volume_.layout().chunk &&
                    volume.levels() == before.volume_.levels() &&
                    volume.layers_present() >= before.volume_.layers_present();
  several_planes_ = before.several_planes_.load();
  if (same) {
    const std::lock_guard lock(before.mutex_);
    cache_.adopt(before.cache_, [&](const BrickKey& key) {
      return before.is_complete(key.first, key.second) && !before.damaged_.contains(key);
    });
  }
}

// Bricks that go from one to the next come from one pool: two would each keep slabs for all.
VolumeBricks::VolumeBricks(const Volume& volume, std::size_t capacity_bytes,
                           const DamagePolicy& policy, const LayerTail* tail, const BlockPool* pool)
    : volume_(volume),
      policy_(policy),
      tail_(tail),
      blocks_(volume.layout().chunk, volume.bits()),
      cells_(volume.layout().chunk),
      pool_(pool != nullptr && pool->block_bytes() == blocks_.brick_bytes()
                ? *pool
                : BlockPool(blocks_.brick_bytes(), TexelBlocks::slack())),
      cache_(
          capacity_bytes, blocks_.brick_bytes(),
          [this](int level, std::span<const BrickFetch> wanted) { return fetch(level, wanted); }) {}

/// Whether all its layers were in the volume when it was opened: such a chunk never changes.
bool VolumeBricks::is_complete(int level, ChunkIndex index) const {
  return (std::int64_t{index.z} + 1) * volume_.layout().chunk[0] * volume_.level(level).factor.z <=
         volume_.layers_present();
}

// Where all of a chunk is decoded anyway, all of it is laid out: to leave cells out would save
// little, and cost as much again when the next plane needs them.
std::vector<BrickPart> VolumeBricks::parts(int level, std::span<const ChunkIndex> wanted,
                                           const PlaneReach& plane) const {
  const CellsNearPlane near(cells_, volume_.layout().chunk, plane);
  std::vector<BrickPart> parts;
  parts.reserve(wanted.size());
  for (const ChunkIndex& index : wanted) {
    const bool is_in_parts = volume_.decodes_by_layers() && !in_tail(level, index);
    parts.push_back({index, is_in_parts ? near.of(index) : cells_.all()});
  }
  return parts;
}

std::vector<TexelBrick> VolumeBricks::bricks(int level, std::span<const ChunkIndex> wanted,
                                             const PlaneReach& plane) {
  return cache_.get(level, parts(level, wanted, plane));
}

bool VolumeBricks::in_tail(int level, ChunkIndex index) const {
  return tail_ != nullptr && tail_->touches(level, index);
}

// What the tail touches is not announced: it is made of images, not of the volume's chunks.
void VolumeBricks::expect(int level, std::span<const ChunkIndex> soon, const PlaneReach& plane) {
  std::vector<ChunkIndex> missing = cache_.missing(level, parts(level, soon, plane));
  std::erase_if(missing, [&](const ChunkIndex& index) { return in_tail(level, index); });
  volume_.expect_chunks(level, missing);
}

std::vector<KeptBrick> VolumeBricks::fetch(int level, std::span<const BrickFetch> wanted) {
  std::vector<KeptBrick> bricks(wanted.size());
  if (std::any_of(wanted.begin(), wanted.end(),
                  [](const BrickFetch& each) { return each.kept != nullptr; })) {
    several_planes_ = true;
  }
  const auto cells = [&, whole = several_planes_.load()](std::size_t place) {
    return whole ? cells_.all() : wanted[place].part.cells;
  };
  Part stored;
  Part overlaid;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const ChunkIndex index = wanted[i].part.index;
    (in_tail(level, index) ? overlaid : stored).add(index, cells_.layers(cells(i)), i);
  }
  const auto keep_in = [&](const Part& part) {
    return [&](std::size_t which, std::span<const std::byte> voxels) {
      const std::size_t place = part.places[which];
      if (!voxels.empty()) {
        bricks[place] = brick_of(voxels, cells(place), wanted[place].kept);
      }
    };
  };
  const auto replace_in = [&](const Part& part) -> Volume::OnDamage {
    if (!policy_.tolerate) {
      return {};
    }
    return [&](std::size_t which, const SampleError& error) {
      note_damage(level, part.chunks[which], error.what());
      bricks[part.places[which]] = damaged_brick();
    };
  };
  volume_.read_chunks(level, stored.chunks, keep_in(stored), replace_in(stored), stored.layers);
  if (!overlaid.chunks.empty()) {
    tail_->read_chunks(level, overlaid.chunks, keep_in(overlaid), replace_in(overlaid));
  }
  return bricks;
}

/// `voxels` has at least the layers of `cells`.
KeptBrick VolumeBricks::brick_of(std::span<const std::byte> voxels, CellSet cells,
                                 const KeptBrick& kept) {
  KeptBrick brick = kept ? kept : std::make_shared<PartialBrick>(pool_.allocate());
  brick->add(cells, [&](CellSet missing, std::byte* texels) {
    cells_.for_each_box(missing,
                        [&](const TexelBlocks::Box& box) { blocks_.lay_out(voxels, box, texels); });
  });
  return brick;
}

KeptBrick VolumeBricks::damaged_brick() {
  const std::size_t voxels = voxels_of(volume_.layout());
  return brick_of(volume_.bits() == 16 ? painted<std::uint16_t>(voxels, policy_.colour)
                                       : painted<std::uint8_t>(voxels, policy_.colour),
                  cells_.all(), nullptr);
}

void VolumeBricks::note_damage(int level, const ChunkIndex& chunk, const std::string& what) {
  const std::lock_guard lock(mutex_);
  const auto [place, is_new] = damaged_.emplace(level, chunk);
  if (is_new && place == damaged_.begin()) {
    first_damage_ = what;
  }
}

Damage VolumeBricks::damage() const {
  const std::lock_guard lock(mutex_);
  return {static_cast<std::int64_t>(damaged_.size()), first_damage_};
}

}  // namespace biotomy::reconstruct
