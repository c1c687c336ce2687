#include "reconstruct/store/volume.hpp"

#include <chrono>
#include <mutex>
#include <string>
#include <utility>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/codecs.hpp"
#include "reconstruct/store/local_object_reader.hpp"
#include "reconstruct/store/lru_map.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/shard.hpp"
#include "reconstruct/store/zarr_array.hpp"

namespace biotomy::reconstruct {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kMetadataName = "zarr.json";
constexpr std::size_t kIndexCacheBytes = std::size_t{64} << 20;
constexpr std::uint64_t kLargestMetadata = std::uint64_t{16} << 20;
constexpr int kMostReplacements = 3;  // of one shard within one read: a writer is not that quick

std::int64_t nanoseconds_since(Clock::time_point start) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count();
}

/// A shard as it was when its index was read.
struct IndexedShard {
  ObjectVersion version;
  ShardIndex index;
};

std::string read_text(ObjectReader& objects, const std::string& name) {
  for (int attempt = 0; attempt < kMostReplacements; ++attempt) {
    const auto version = objects.version(name);
    if (!version) {
      throw SampleError(objects.describe(name) + ": is missing; there is no volume here");
    }
    if (version->size > kLargestMetadata) {
      throw SampleError(objects.describe(name) + ": is too large for metadata");
    }
    std::string text(version->size, '\0');
    try {
      objects.read(name, *version, 0, std::as_writable_bytes(std::span(text)));
      return text;
    } catch (const ObjectReplaced&) {
      continue;  // a layer was added just now
    }
  }
  throw SampleError(objects.describe(name) + ": keeps changing while it is read");
}

std::vector<PyramidLevel> levels_of(const Cuboid& cuboid, const std::vector<LevelFactor>& factors) {
  std::vector<PyramidLevel> levels;
  for (const LevelFactor& factor : factors) {
    levels.push_back(pyramid_level(cuboid, factor));
  }
  return levels;
}

ZarrArray read_array(ObjectReader& objects, int level) {
  const std::string name = level_path(level) + "/" + kMetadataName;
  return parse_array_metadata(read_text(objects, name), objects.describe(name));
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

  /// Null when the shard is not stored.
  std::shared_ptr<const IndexedShard> load_shard(const std::string& name) {
    const auto version = objects->version(name);
    if (!version) {
      return nullptr;
    }
    std::vector<std::byte> index(
        shard_index_bytes(static_cast<std::size_t>(chunks_of_one_shard.total())));
    if (version->size < index.size()) {
      throw SampleError(objects->describe(name) + ": is truncated: it is shorter than its index");
    }
    read(name, *version, version->size - index.size(), index);
    auto shard = std::make_shared<IndexedShard>();
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

  std::shared_ptr<const IndexedShard> shard(const std::string& name) {
    {
      const std::lock_guard lock(mutex);
      if (const auto* found = shards.find(name); found != nullptr) {
        return *found;
      }
    }
    return load_shard(name);
  }

  std::shared_ptr<const ChunkVoxels> decode(const std::string& name, ChunkIndex chunk,
                                            const std::vector<std::byte>& encoded) {
    const auto start = Clock::now();
    auto voxels = std::make_shared<ChunkVoxels>(codec.chunk_bytes());
    try {
      codec.decode(encoded, *voxels);
    } catch (const SampleError& error) {
      throw SampleError(objects->describe(name) + ": the chunk z " + std::to_string(chunk.z) +
                        ", y " + std::to_string(chunk.y) + ", x " + std::to_string(chunk.x) +
                        " is damaged: " + error.what());
    }
    statistics.decode_ns += nanoseconds_since(start);
    ++statistics.chunks_read;
    return voxels;
  }
};

Volume::Volume(std::unique_ptr<State> state) : state_(std::move(state)) {}
Volume::~Volume() = default;
Volume::Volume(Volume&&) noexcept = default;

Volume Volume::open(const std::filesystem::path& path) {
  auto objects = std::make_unique<LocalObjectReader>(path);
  VolumeMetadata metadata =
      parse_group_metadata(read_text(*objects, kMetadataName), objects->describe(kMetadataName));
  const ZarrArray array = read_array(*objects, 0);
  if (array.bits != metadata.bits || metadata.layers_present > array.size.z) {
    throw SampleError(path.string() + ": its metadata and its array contradict each other");
  }
  auto state = std::make_unique<State>(std::move(objects), std::move(metadata), array);
  for (std::size_t level = 1; level < state->levels.size(); ++level) {
    ZarrArray expected = array;
    expected.size = state->levels[level].size;
    if (read_array(*state->objects, static_cast<int>(level)) != expected) {
      throw SampleError(path.string() + ": its level " + std::to_string(level) +
                        " does not fit level 0; build the volume anew");
    }
  }
  return Volume(std::move(state));
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
  const BlockCount& per_shard = state_->chunks_of_one_shard;
  const std::string name =
      level_path(level) + "/" +
      shard_key(chunk.z / per_shard.z, chunk.y / per_shard.y, chunk.x / per_shard.x);
  const std::int64_t place =
      ((chunk.z % per_shard.z) * per_shard.y + chunk.y % per_shard.y) * per_shard.x +
      chunk.x % per_shard.x;

  auto shard = state_->shard(name);
  for (int attempt = 0; shard && attempt < kMostReplacements; ++attempt) {
    const ChunkRange range = shard->index[static_cast<std::size_t>(place)];
    if (!range.stored()) {
      return nullptr;
    }
    std::vector<std::byte> encoded(range.length);
    try {
      state_->read(name, shard->version, range.offset, encoded);
      return state_->decode(name, chunk, encoded);
    } catch (const ObjectReplaced&) {
      shard = state_->load_shard(name);
    }
  }
  if (shard) {
    throw SampleError(state_->objects->describe(name) + ": keeps changing while it is read");
  }
  return nullptr;
}

}  // namespace biotomy::reconstruct
