#include "tests/bench/chunk_ranges.hpp"

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <tuple>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/shard.hpp"

namespace biotomy::bench {
namespace {

namespace fs = std::filesystem;
using namespace biotomy::reconstruct;

ShardIndex read_index(const fs::path& shard, std::size_t chunk_count) {
  std::ifstream in(shard, std::ios::binary | std::ios::ate);
  const auto shard_bytes = static_cast<std::uint64_t>(std::max<std::streamoff>(in.tellg(), 0));
  std::vector<std::byte> index(shard_index_bytes(chunk_count));
  if (!in || shard_bytes < index.size()) {
    throw SampleError(shard.string() + ": cannot be read, or is shorter than its index");
  }
  in.seekg(-static_cast<std::streamoff>(index.size()), std::ios::end);
  if (!in.read(reinterpret_cast<char*>(index.data()), static_cast<std::streamsize>(index.size()))) {
    throw SampleError(shard.string() + ": its index cannot be read");
  }
  try {
    return parse_shard_index(index, shard_bytes);
  } catch (const SampleError& error) {
    throw SampleError(shard.string() + ": is damaged: " + error.what());
  }
}

}  // namespace

std::uint64_t ChunkRanges::bytes() const {
  std::uint64_t sum = 0;
  for (const ChunkBytes& chunk : chunks) {
    sum += chunk.length;
  }
  return sum;
}

ChunkRanges find_chunks(const fs::path& level, const ZarrArray& array,
                        const std::vector<ChunkPlace>& places) {
  const BlockCount per_shard = chunks_of_shard(array.layout);
  std::map<ChunkPlace, std::vector<ChunkPlace>> shards;
  for (const ChunkPlace& chunk : places) {
    shards[{chunk.z / per_shard.z, chunk.y / per_shard.y, chunk.x / per_shard.x}].push_back(chunk);
  }
  ChunkRanges found;
  for (const auto& [place, chunks] : shards) {
    const fs::path file = level / shard_key(place.z, place.y, place.x);
    if (!fs::exists(file)) {
      continue;  // all of it is fill value
    }
    const ShardIndex index = read_index(file, static_cast<std::size_t>(per_shard.total()));
    const std::size_t number = found.files.size();
    found.files.push_back(file);
    for (const ChunkPlace& chunk : chunks) {
      const std::int64_t entry =
          ((chunk.z % per_shard.z) * per_shard.y + chunk.y % per_shard.y) * per_shard.x +
          chunk.x % per_shard.x;
      const ChunkRange& range = index[static_cast<std::size_t>(entry)];
      if (range.stored()) {
        found.chunks.push_back({number, range.offset, range.length});
      }
    }
  }
  std::sort(found.chunks.begin(), found.chunks.end(), [](const auto& a, const auto& b) {
    return std::tie(a.file, a.offset) < std::tie(b.file, b.offset);
  });
  return found;
}

}  // namespace biotomy::bench
