#include "reconstruct/store/layers_in_shards.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/codecs.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/stored_shard.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

/// The Z of a shard's name `c/0/Z/Y/X`, from its path below `c/0`.
std::optional<std::int64_t> band_of(const fs::path& below) {
  const std::string name = below.begin()->string();
  std::int64_t z = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), z);
  if (error != std::errc() || end != name.data() + name.size() || z < 0) {
    return std::nullopt;
  }
  return z;
}

/// The shards of level 0 by their Z. Hidden files were never finished.
std::map<std::int64_t, std::vector<fs::path>> shards_by_band(const fs::path& volume) {
  std::map<std::int64_t, std::vector<fs::path>> bands;
  const fs::path folder = volume / level_path(0) / "c" / "0";
  std::error_code error;
  for (auto entry = fs::recursive_directory_iterator(folder, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const fs::path path = entry->path();
    const auto band = band_of(path.lexically_relative(folder));
    if (band && entry->is_regular_file() && path.filename().string().front() != '.') {
      bands[*band].push_back(path);
    }
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    throw SampleError(folder.string() + ": cannot be listed: " + error.message());
  }
  return bands;
}

/// The deepest layer of a shard, from 1, that is not all fill value; 0 where there is none.
int deepest_layer(const StoredShard& shard, const ZarrArray& array) {
  const ChunkCodec codec(array.layout, array.bits);
  const BlockCount count = chunks_of_shard(array.layout);
  const int depth = array.layout.chunk[0];
  std::vector<std::byte> voxels(codec.chunk_bytes());
  const std::size_t layer_bytes = voxels.size() / static_cast<std::size_t>(depth);
  int deepest = 0;
  for (std::int64_t place = count.total() - 1; place >= 0; --place) {
    const int first = static_cast<int>(place / (count.y * count.x)) * depth;
    if (first + depth <= deepest || !shard.stores(static_cast<std::size_t>(place))) {
      continue;
    }
    shard.decode(static_cast<std::size_t>(place), codec, voxels);
    for (int k = depth; first + k > deepest && k > 0; --k) {
      const auto layer =
          std::span(voxels).subspan(static_cast<std::size_t>(k - 1) * layer_bytes, layer_bytes);
      if (std::any_of(layer.begin(), layer.end(), [](std::byte b) { return b != std::byte{0}; })) {
        deepest = first + k;
      }
    }
  }
  return deepest;
}

}  // namespace

bool has_shards(const fs::path& volume) {
  return !shards_by_band(volume).empty();
}

std::int64_t layers_in_shards(const fs::path& volume, const ZarrArray& finest) {
  auto bands = shards_by_band(volume);
  bands.erase(bands.lower_bound(shards_of(finest).z), bands.end());  // do not belong to it
  if (bands.empty()) {
    return 0;
  }
  const auto& [z, shards] = *bands.rbegin();
  const int depth = finest.layout.shard[0];
  int layers = 1;
  for (const fs::path& path : shards) {
    try {
      const auto shard = StoredShard::open(path, finest);
      layers = std::max(layers, shard ? deepest_layer(*shard, finest) : 0);
    } catch (const SampleError&) {
      layers = depth;
    }
  }
  return std::min(z * depth + layers, finest.size.z);
}

}  // namespace biotomy::reconstruct
