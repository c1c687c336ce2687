#include "reconstruct/store/shard.hpp"

#include <algorithm>
#include <iterator>
#include <string>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/crc32c.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr std::size_t kNumberBytes = 8;
constexpr std::size_t kRangeBytes = 2 * kNumberBytes;
constexpr std::size_t kChecksumBytes = 4;

void append_little_endian(std::vector<std::byte>& out, std::uint64_t number, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) {
    out.push_back(static_cast<std::byte>(number >> (8 * i)));
  }
}

std::uint64_t little_endian(std::span<const std::byte> bytes) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    number |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
  }
  return number;
}

/// Whether two chunks share bytes. Quick for the order in which a shard is written, which is that
/// of the index.
bool overlap(const ShardIndex& index) {
  ShardIndex stored;
  std::copy_if(index.begin(), index.end(), std::back_inserter(stored),
               [](const ChunkRange& range) { return range.stored(); });
  const auto before = [](const ChunkRange& a, const ChunkRange& b) { return a.offset < b.offset; };
  if (!std::is_sorted(stored.begin(), stored.end(), before)) {
    std::sort(stored.begin(), stored.end(), before);
  }
  return std::adjacent_find(stored.begin(), stored.end(),
                            [](const ChunkRange& a, const ChunkRange& b) {
                              return b.offset < a.offset + a.length;
                            }) != stored.end();
}

}  // namespace

std::vector<std::byte> encode_shard_index(const std::vector<std::vector<std::byte>>& chunks) {
  std::vector<std::byte> index;
  std::uint64_t offset = 0;
  for (const auto& chunk : chunks) {
    const ChunkRange range = chunk.empty() ? ChunkRange{} : ChunkRange{offset, chunk.size()};
    offset += chunk.size();
    append_little_endian(index, range.offset, kNumberBytes);
    append_little_endian(index, range.length, kNumberBytes);
  }
  append_little_endian(index, crc32c(index), kChecksumBytes);
  return index;
}

std::size_t shard_index_bytes(std::size_t chunk_count) {
  return chunk_count * kRangeBytes + kChecksumBytes;
}

ShardIndex parse_shard_index(std::span<const std::byte> bytes, std::uint64_t shard_bytes,
                             std::uint64_t longest_chunk) {
  if (bytes.size() < kChecksumBytes || (bytes.size() - kChecksumBytes) % kRangeBytes != 0 ||
      shard_bytes < bytes.size()) {
    throw SampleError("it is shorter than its index");
  }
  const auto ranges = bytes.first(bytes.size() - kChecksumBytes);
  if (little_endian(bytes.last(kChecksumBytes)) != crc32c(ranges)) {
    throw SampleError("the checksum of its index is wrong");
  }
  const std::uint64_t chunk_bytes = shard_bytes - bytes.size();
  ShardIndex index(ranges.size() / kRangeBytes);
  for (std::size_t i = 0; i < index.size(); ++i) {
    const auto range = ranges.subspan(i * kRangeBytes, kRangeBytes);
    index[i] = {little_endian(range.first(kNumberBytes)), little_endian(range.last(kNumberBytes))};
    if (index[i].stored() &&
        (index[i].length > chunk_bytes || index[i].offset > chunk_bytes - index[i].length)) {
      throw SampleError("its index leads out of it");
    }
    if (index[i].stored() && index[i].length > longest_chunk) {
      throw SampleError("its index tells of a chunk of " + std::to_string(index[i].length) +
                        " bytes, more than any has");
    }
  }
  if (overlap(index)) {
    throw SampleError("its index lets chunks overlap");
  }
  return index;
}

}  // namespace biotomy::reconstruct
