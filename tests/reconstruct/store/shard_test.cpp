#include "reconstruct/store/shard.hpp"

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/crc32c.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/whole_shard.hpp"

namespace biotomy::reconstruct {
namespace {

using Bytes = std::vector<std::byte>;

Bytes filled(std::size_t size, int value) {
  return Bytes(size, static_cast<std::byte>(value));
}

std::span<const std::byte> index_of(const Bytes& shard, std::size_t chunks) {
  return std::span(shard).last(shard_index_bytes(chunks));
}

TEST(Shard, IndexTellsWhereEachChunkLies) {
  const Bytes shard = whole_shard({filled(5, 1), {}, filled(3, 2)});
  const ShardIndex index = parse_shard_index(index_of(shard, 3), shard.size());
  EXPECT_EQ(shard.size(), 8 + 3 * 16 + 4U);
  EXPECT_EQ(index, (ShardIndex{{0, 5}, {}, {5, 3}}));
  EXPECT_FALSE(index[1].stored());
  EXPECT_EQ(shard[5], std::byte{2});
}

TEST(Shard, FillValueIsAllOnesInTheIndex) {
  const Bytes shard = whole_shard({{}, filled(1, 9)});
  EXPECT_EQ(Bytes(shard.begin() + 1, shard.begin() + 17), filled(16, 0xFF));
}

TEST(Shard, OfNothingButFillValueIsAnIndexAlone) {
  const Bytes shard = whole_shard({{}, {}});
  EXPECT_EQ(shard.size(), shard_index_bytes(2));
  EXPECT_EQ(parse_shard_index(shard, shard.size()), ShardIndex(2));
}

TEST(Shard, RefusesAnIndexWithAWrongChecksum) {
  Bytes shard = whole_shard({filled(5, 1)});
  shard[7] ^= std::byte{1};
  EXPECT_THAT(message_of<SampleError>([&] { parse_shard_index(index_of(shard, 1), shard.size()); }),
              testing::HasSubstr("checksum"));
}

TEST(Shard, RefusesARangeThatLeadsOutOfTheShard) {
  const Bytes shard = whole_shard({filled(5, 1)});
  // The same index, with its good checksum, on a shard that lost a byte of its chunk.
  EXPECT_THAT(
      message_of<SampleError>([&] { parse_shard_index(index_of(shard, 1), shard.size() - 1); }),
      testing::HasSubstr("leads out"));
}

/// The index as it would end a shard, with its good checksum.
Bytes index_bytes(const ShardIndex& index) {
  Bytes bytes;
  for (const ChunkRange& range : index) {
    for (const std::uint64_t number : {range.offset, range.length}) {
      for (int shift = 0; shift < 64; shift += 8) {
        bytes.push_back(static_cast<std::byte>(number >> shift));
      }
    }
  }
  const std::uint32_t crc = crc32c(bytes);
  for (int shift = 0; shift < 32; shift += 8) {
    bytes.push_back(static_cast<std::byte>(crc >> shift));
  }
  return bytes;
}

constexpr std::uint64_t kLargestShard = std::uint64_t{1} << 40;

TEST(Shard, RefusesRangesThatOverflow) {
  for (const ChunkRange& range :
       {ChunkRange{~std::uint64_t{0} - 1, 10}, ChunkRange{10, ~std::uint64_t{0} - 1},
        ChunkRange{ChunkRange::kNotStored, 10}, ChunkRange{10, ChunkRange::kNotStored}}) {
    EXPECT_THAT(
        message_of<SampleError>([&] { parse_shard_index(index_bytes({range}), kLargestShard); }),
        testing::HasSubstr("leads out"));
  }
}

TEST(Shard, TakesChunksInAnyOrderButNoneThatOverlap) {
  const ShardIndex apart{{20, 10}, {}, {0, 10}, {10, 10}};
  EXPECT_EQ(parse_shard_index(index_bytes(apart), 1000), apart);
  const ShardIndex overlapping{{20, 10}, {}, {0, 11}, {10, 10}};
  EXPECT_THAT(message_of<SampleError>([&] { parse_shard_index(index_bytes(overlapping), 1000); }),
              testing::HasSubstr("overlap"));
}

TEST(Shard, RefusesAChunkLongerThanAnyIs) {
  const Bytes index = index_bytes({{0, 5000}});
  EXPECT_EQ(parse_shard_index(index, kLargestShard, 5000).size(), 1U);
  EXPECT_THAT(message_of<SampleError>([&] { parse_shard_index(index, kLargestShard, 4999); }),
              testing::HasSubstr("5000 bytes"));
}

TEST(Shard, RefusesAnIndexThatIsCutShort) {
  const Bytes index = index_bytes({{0, 5}, {5, 5}});
  for (const std::size_t length : {0, 3, 15, 35}) {
    EXPECT_THAT(
        message_of<SampleError>([&] { parse_shard_index(std::span(index).first(length), 1000); }),
        testing::HasSubstr("shorter than its index"))
        << length;
  }
  EXPECT_THROW(parse_shard_index(index, index.size() - 1), SampleError);
}

}  // namespace
}  // namespace biotomy::reconstruct
