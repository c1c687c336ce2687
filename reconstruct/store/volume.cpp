#include "reconstruct/store/volume.hpp"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>

#include <oneapi/tbb/parallel_for.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/codecs.hpp"
#include "reconstruct/store/local_object_reader.hpp"
#include "reconstruct/store/lru_map.hpp"
#include "reconstruct/store/metadata_text.hpp"
#include "reconstruct/store/missing_part.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/shard.hpp"
#include "reconstruct/store/volume_misfit.hpp"
#include "reconstruct/store/zarr_array.hpp"
#include "reconstruct/whole_loop.hpp"

namespace biotomy::reconstruct {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kIndexCacheBytes = std::size_t{64} << 20;
constexpr std::uint64_t kLongestRead = std::uint64_t{1} << 18;  // bytes, then decoded by one task
constexpr std::uint64_t kLongestExpected = std::uint64_t{1} << 23;
constexpr BlockCount kNoShard{-1, -1, -1};
constexpr int kMostReplacements = 3;  // of one shard within one read: a writer is not that quick

std::int64_t nanoseconds_since(Clock::time_point start) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count();
}

/// A shard as it was when its index was read.
struct IndexedShard {
  std::string name;
  ObjectVersion version;
  ShardIndex index;
};

/// A stored chunk among those that were asked for.
struct Piece {
  std::shared_ptr<const IndexedShard> shard;
  ChunkRange range;
  std::size_t which = 0;
};

bool follows(const Piece& before, const Piece& piece) {
  return piece.shard == before.shard &&
         piece.range.offset == before.range.offset + before.range.length;
}

/// Pieces that lie side by side in one shard.
using Run = std::span<const Piece>;

std::uint64_t bytes_of(Run run) {
  return run.back().range.offset + run.back().range.length - run.front().range.offset;
}

/// Sorts the pieces and cuts them into runs of up to `longest` bytes, or of one piece.
std::vector<Run> runs_of(std::vector<Piece>& pieces, std::uint64_t longest) {
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return std::tie(a.shard->name, a.range.offset) < std::tie(b.shard->name, b.range.offset);
  });
  std::vector<Run> runs;
  for (std::size_t first = 0; first < pieces.size();) {
    std::size_t end = first + 1;
    std::uint64_t bytes = pieces[first].range.length;
    while (end < pieces.size() && follows(pieces[end - 1], pieces[end]) &&
           bytes + pieces[end].range.length <= longest) {
      bytes += pieces[end++].range.length;
    }
    runs.emplace_back(pieces.data() + first, end - first);
    first = end;
  }
  return runs;
}

/// Memory that is used again, and not cleared.
class Scratch {
 public:
  std::span<std::byte> bytes(std::size_t count) {
    if (count > size_) {
      memory_ = std::make_unique_for_overwrite<std::byte[]>(count);
      size_ = count;
    }
    return {memory_.get(), count};
  }

 private:
  std::unique_ptr<std::byte[]> memory_;
  std::size_t size_ = 0;
};

std::vector<PyramidLevel> levels_of(const Cuboid& cuboid, const std::vector<LevelFactor>& factors) {
  std::vector<PyramidLevel> levels;
  levels.reserve(factors.size());
  for (const LevelFactor& factor : factors) {
    levels.push_back(pyramid_level(cuboid, factor));
  }
  return levels;
}

VolumeMetadata read_group(ObjectReader& objects) {
  const auto text = read_metadata_text(objects, kMetadataName);
  if (!text) {
    throw SampleError(objects.describe(kMetadataName) + ": is missing; there is no volume here");
  }
  return parse_group_metadata(*text, objects.describe(kMetadataName));
}

std::string array_name(int level) {
  return level_path(level) + "/" + kMetadataName;
}

ZarrArray read_array(ObjectReader& objects, int level) {
  const std::string name = array_name(level);
  const auto text = read_metadata_text(objects, name);
  if (!text) {
    throw SampleError(objects.describe(name) + ": " + kIsMissing);
  }
  return parse_array_metadata(*text, objects.describe(name));
}

}  // namespace

struct Volume::State {
  std::unique_ptr<ObjectReader> objects;
  VolumeMetadata metadata;
  ZarrArray array;  // of level 0; the others differ in size alone
  Cuboid cuboid;
  std::vector<PyramidLevel> levels;
  BlockCount chunks_of_one_shard;
  ChunkCodec codec;
  ReadStatistics statistics;
  std::mutex mutex;
  LruMap<std::string, std::shared_ptr<const IndexedShard>> shards{kIndexCacheBytes};

  State(std::unique_ptr<ObjectReader> reader, VolumeMetadata group, const ZarrArray& level)
      : objects(std::move(reader)),
        metadata(std::move(group)),
        array(level),
        cuboid{level.size, metadata.spacing},
        levels(levels_of(cuboid, metadata.levels)),
        chunks_of_one_shard(chunks_of_shard(level.layout)),
        codec(level.layout, level.bits) {}

  void read(const std::string& name, const ObjectVersion& version, std::uint64_t offset,
            std::span<std::byte> out) {
    const auto start = Clock::now();
    objects->read(name, version, offset, out);
    statistics.read_ns += nanoseconds_since(start);
    statistics.bytes_read += static_cast<std::int64_t>(out.size());
  }

  /// Null when the shard is not stored and need not be. Throws ObjectReplaced.
  std::shared_ptr<const IndexedShard> load_shard(int level, ChunkIndex chunk) {
    const std::string name = shard_name(level, chunk);
    const auto version = objects->version(name);
    if (!version) {
      if (must_be_stored(level, chunk)) {
        throw SampleError(objects->describe(name) + ": " + kIsMissing);
      }
      return nullptr;
    }
    const std::size_t index_bytes =
        shard_index_bytes(static_cast<std::size_t>(chunks_of_one_shard.total()));
    if (version->size < index_bytes) {
      throw SampleError(objects->describe(name) + ": is truncated: it is shorter than its index");
    }
    std::vector<std::byte> index(index_bytes);
    read(name, *version, version->size - index_bytes, index);
    auto shard = std::make_shared<IndexedShard>();
    shard->name = name;
    shard->version = *version;
    try {
      shard->index = parse_shard_index(index, version->size, codec.longest_encoded());
    } catch (const SampleError& error) {
      throw SampleError(objects->describe(name) + ": is damaged: " + error.what());
    }
    const std::lock_guard lock(mutex);
    shards.put(name, shard, index.size());
    return shard;
  }

  std::shared_ptr<const IndexedShard> shard(int level, ChunkIndex chunk) {
    {
      const std::lock_guard lock(mutex);
      if (const auto* found = shards.find(shard_name(level, chunk)); found != nullptr) {
        return *found;
      }
    }
    return fresh_shard(level, chunk);
  }

  /// As it is stored now.
  std::shared_ptr<const IndexedShard> fresh_shard(int level, ChunkIndex chunk) {
    for (int attempt = 0; attempt < kMostReplacements; ++attempt) {
      try {
        return load_shard(level, chunk);
      } catch (const ObjectReplaced&) {
        continue;
      }
    }
    throw SampleError(objects->describe(shard_name(level, chunk)) +
                      ": keeps changing while it is read");
  }

  /// As ChunkCodec::decode_layers.
  std::span<const std::byte> decode(const std::string& name, ChunkIndex chunk,
                                    std::span<const std::byte> encoded, ChunkLayers layers,
                                    std::span<std::byte> room) {
    const auto start = Clock::now();
    try {
      const std::span<const std::byte> voxels = codec.decode_layers(encoded, layers, room);
      statistics.decode_ns += nanoseconds_since(start);
      ++statistics.chunks_read;
      return voxels;
    } catch (const SampleError& error) {
      throw SampleError(objects->describe(name) + ": the chunk z " + std::to_string(chunk.z) +
                        ", y " + std::to_string(chunk.y) + ", x " + std::to_string(chunk.x) +
                        " is damaged: " + error.what());
    }
  }

  ChunkLayers all_layers() const { return {0, array.layout.chunk[0]}; }

  /// How many shards lie before a chunk's along each axis.
  BlockCount shard_of(ChunkIndex chunk) const {
    const BlockCount& per_shard = chunks_of_one_shard;
    return {chunk.z / per_shard.z, chunk.y / per_shard.y, chunk.x / per_shard.x};
  }

  std::string shard_name(int level, ChunkIndex chunk) const {
    const BlockCount shard = shard_of(chunk);
    return level_path(level) + "/" + shard_key(shard.z, shard.y, shard.x);
  }

  /// Whether the chunk's shard has a part in the layers that are present, of a volume that stores
  /// every such shard.
  bool must_be_stored(int level, ChunkIndex chunk) const {
    const std::int64_t first = chunk.z / chunks_of_one_shard.z * array.layout.shard[0];
    return metadata.every_shard &&
           first < layers_present_at(metadata, static_cast<std::size_t>(level));
  }

  std::size_t place_in_shard(ChunkIndex chunk) const {
    const BlockCount& per_shard = chunks_of_one_shard;
    return static_cast<std::size_t>(
        ((chunk.z % per_shard.z) * per_shard.y + chunk.y % per_shard.y) * per_shard.x +
        chunk.x % per_shard.x);
  }

  /// Of each chunk its bytes' place, if it is stored; `on_nothing` is called for the others.
  template <typename OnNothing, typename OnFailure>
  std::vector<Piece> find(int level, std::span<const ChunkIndex> chunks, OnNothing&& on_nothing,
                          OnFailure&& on_failure) {
    std::vector<Piece> pieces;
    pieces.reserve(chunks.size());
    BlockCount known = kNoShard;  // whose index is at hand: neighbours mostly share one
    std::shared_ptr<const IndexedShard> found;
    for (std::size_t which = 0; which < chunks.size(); ++which) {
      try {
        if (const BlockCount place = shard_of(chunks[which]); place != known) {
          known = kNoShard;
          found = shard(level, chunks[which]);
          known = place;
        }
        const ChunkRange range = found ? found->index[place_in_shard(chunks[which])] : ChunkRange{};
        if (range.stored()) {
          pieces.push_back({found, range, which});
        } else {
          on_nothing(which);
        }
      } catch (const SampleError& error) {
        on_failure(which, error);
      }
    }
    return pieces;
  }
};

Volume::Volume(std::unique_ptr<State> state) : state_(std::move(state)) {}
Volume::~Volume() = default;
Volume::Volume(Volume&&) noexcept = default;

Volume Volume::open(const std::filesystem::path& path) {
  return open(std::make_unique<LocalObjectReader>(path));
}

Volume Volume::open(std::unique_ptr<ObjectReader> objects) {
  VolumeMetadata metadata = read_group(*objects);
  const ZarrArray array = read_array(*objects, 0);
  if (array.bits != metadata.bits || metadata.layers_present > array.size.z) {
    throw SampleError(objects->describe(kMetadataName) + ": contradicts " +
                      objects->describe(array_name(0)));
  }
  auto state = std::make_unique<State>(std::move(objects), std::move(metadata), array);
  for (std::size_t level = 1; level < state->levels.size(); ++level) {
    ZarrArray expected = array;
    expected.size = state->levels[level].size;
    const int number = static_cast<int>(level);
    if (read_array(*state->objects, number) != expected) {
      throw SampleError(state->objects->describe(array_name(number)) +
                        ": does not fit level 0; biotomy rebuild makes the volume anew");
    }
  }
  return Volume(std::move(state));
}

Volume Volume::of_sample(const SampleFolder& sample) {
  const std::filesystem::path path = sample.volume_path();
  const SampleDescription& description = sample.description();
  // A writer makes the metadata first, and its group last: shards without it are a damaged volume.
  std::error_code error;
  if (std::filesystem::exists(path / kMetadataName, error) ||
      std::filesystem::exists(path / level_path(0) / "c", error)) {
    Volume volume = open(path);
    if (const auto what = misfit(volume.cuboid(), volume.bits(), sample)) {
      throw SampleError(path.string() + ": " + *what);
    }
    return volume;
  }
  ZarrArray array;
  array.size = description.cuboid.size;
  array.bits = description.bits;
  VolumeMetadata metadata;
  metadata.name = description.name;
  metadata.spacing = description.cuboid.spacing;
  metadata.bits = description.bits;
  metadata.levels = pyramid_factors(description.cuboid, array.layout.chunk);
  return Volume(std::make_unique<State>(std::make_unique<LocalObjectReader>(path),
                                        std::move(metadata), array));
}

const Cuboid& Volume::cuboid() const {
  return state_->cuboid;
}
int Volume::levels() const {
  return static_cast<int>(state_->levels.size());
}
const PyramidLevel& Volume::level(int number) const {
  return state_->levels.at(static_cast<std::size_t>(number));
}
const VolumeLayout& Volume::layout() const {
  return state_->array.layout;
}
int Volume::bits() const {
  return state_->array.bits;
}
std::int64_t Volume::layers_present() const {
  return state_->metadata.layers_present;
}
const ReadStatistics& Volume::statistics() const {
  return state_->statistics;
}

std::shared_ptr<const ChunkVoxels> Volume::read_chunk(int level, ChunkIndex chunk) const {
  const std::string name = state_->shard_name(level, chunk);
  auto shard = state_->shard(level, chunk);
  for (int attempt = 0; shard && attempt < kMostReplacements; ++attempt) {
    const ChunkRange range = shard->index[state_->place_in_shard(chunk)];
    if (!range.stored()) {
      return nullptr;
    }
    std::vector<std::byte> encoded(range.length);
    try {
      state_->read(name, shard->version, range.offset, encoded);
      ChunkVoxels room(state_->codec.chunk_bytes());
      const auto voxels = state_->decode(name, chunk, encoded, state_->all_layers(), room);
      return std::make_shared<ChunkVoxels>(voxels.data() == room.data()
                                               ? std::move(room)
                                               : ChunkVoxels(voxels.begin(), voxels.end()));
    } catch (const ObjectReplaced&) {
      shard = state_->fresh_shard(level, chunk);
    }
  }
  if (shard) {
    throw SampleError(state_->objects->describe(name) + ": keeps changing while it is read");
  }
  return nullptr;
}

void Volume::read_chunks(int level, std::span<const ChunkIndex> wanted, const OnChunk& on_chunk,
                         const OnDamage& on_damage, std::span<const ChunkLayers> layers) const {
  const auto fail = [&](std::size_t which, const SampleError& error) {
    if (!on_damage) {
      throw SampleError(error);
    }
    on_damage(which, error);
  };
  // One by one: a chunk whose shard was replaced meanwhile, or whose run can't be read as a whole.
  const auto read_alone = [&](const Piece& piece) {
    try {
      const auto voxels = read_chunk(level, wanted[piece.which]);
      on_chunk(piece.which, voxels ? std::span<const std::byte>(*voxels) : std::span<std::byte>());
    } catch (const SampleError& error) {
      fail(piece.which, error);
    }
  };
  const auto read_run = [&](Run run) {
    thread_local Scratch encoded_memory;
    thread_local Scratch voxel_memory;
    const std::span<std::byte> encoded = encoded_memory.bytes(bytes_of(run));
    const std::span<std::byte> room = voxel_memory.bytes(state_->codec.chunk_bytes());
    const IndexedShard& shard = *run.front().shard;
    try {
      state_->read(shard.name, shard.version, run.front().range.offset, encoded);
    } catch (const std::runtime_error&) {
      std::for_each(run.begin(), run.end(), read_alone);
      return;
    }
    for (const Piece& piece : run) {
      std::span<const std::byte> voxels;
      try {
        voxels = state_->decode(
            shard.name, wanted[piece.which],
            encoded.subspan(piece.range.offset - run.front().range.offset, piece.range.length),
            layers.empty() ? state_->all_layers() : layers[piece.which], room);
      } catch (const SampleError& error) {
        fail(piece.which, error);
        continue;
      }
      on_chunk(piece.which, voxels);
    }
  };
  std::vector<Piece> pieces = state_->find(
      level, wanted, [&](std::size_t which) { on_chunk(which, {}); }, fail);
  const std::vector<Run> runs = runs_of(pieces, kLongestRead);
  whole_loop(runs.size(), [&](std::size_t i) { read_run(runs[i]); });
}

bool Volume::decodes_by_layers() const {
  return state_->codec.decodes_by_layers();
}

void Volume::expect_chunks(int level, std::span<const ChunkIndex> soon) const {
  const auto ignore = [](std::size_t, const auto&...) {};  // the reading will say it
  std::vector<Piece> pieces = state_->find(level, soon, ignore, ignore);
  const std::vector<Run> runs = runs_of(pieces, kLongestExpected);
  tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t i) {
    const Piece& first = runs[i].front();
    state_->objects->expect(first.shard->name, first.shard->version, first.range.offset,
                            bytes_of(runs[i]));
  });
}

}  // namespace biotomy::reconstruct
