#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace biotomy::reconstruct {

/// Where an inner chunk's encoded bytes lie in a shard. Both numbers are 2^64 − 1 for a chunk that
/// is not stored because all of it is fill value.
struct ChunkRange {
  static constexpr std::uint64_t kNotStored = ~std::uint64_t{0};

  std::uint64_t offset = kNotStored;
  std::uint64_t length = kNotStored;

  bool stored() const { return offset != kNotStored || length != kNotStored; }
  friend bool operator==(const ChunkRange&, const ChunkRange&) = default;
};

/// One range for each inner chunk, x running fastest, then y, then z.
using ShardIndex = std::vector<ChunkRange>;

/// Zarr v3, codec `sharding_indexed` 1.0: a shard is the encoded chunks one after the other, then
/// the index as little-endian 64-bit numbers, then its CRC-32C; these two are what this returns. A
/// chunk without bytes is fill value; where all are, the shard is an index alone.
std::vector<std::byte> encode_shard_index(const std::vector<std::vector<std::byte>>& chunks);

/// Bytes of the index with its checksum: the last of a shard.
std::size_t shard_index_bytes(std::size_t chunk_count);

/// `bytes` are the last shard_index_bytes() of a shard of `shard_bytes` bytes. Throws SampleError,
/// without the shard's name, when the checksum is wrong, a range leads out of the shard or is
/// longer than `longest_chunk` (ChunkCodec::longest_encoded()), or two ranges overlap.
ShardIndex parse_shard_index(std::span<const std::byte> bytes, std::uint64_t shard_bytes,
                             std::uint64_t longest_chunk = ChunkRange::kNotStored);

}  // namespace biotomy::reconstruct
