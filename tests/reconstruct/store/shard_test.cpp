#include "reconstruct/store/shard.hpp"

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"

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
  const Bytes shard = encode_shard({filled(5, 1), {}, filled(3, 2)});
  const ShardIndex index = parse_shard_index(index_of(shard, 3), shard.size());
  EXPECT_EQ(shard.size(), 8 + 3 * 16 + 4U);
  EXPECT_EQ(index, (ShardIndex{{0, 5}, {}, {5, 3}}));
  EXPECT_FALSE(index[1].stored());
  EXPECT_EQ(shard[5], std::byte{2});
}

TEST(Shard, FillValueIsAllOnesInTheIndex) {
  const Bytes shard = encode_shard({{}, filled(1, 9)});
  EXPECT_EQ(Bytes(shard.begin() + 1, shard.begin() + 17), filled(16, 0xFF));
}

TEST(Shard, OfNothingButFillValueIsEmpty) {
  EXPECT_TRUE(encode_shard({{}, {}}).empty());
}

TEST(Shard, RefusesAnIndexWithAWrongChecksum) {
  Bytes shard = encode_shard({filled(5, 1)});
  shard[7] ^= std::byte{1};
  EXPECT_THAT(message_of<SampleError>([&] { parse_shard_index(index_of(shard, 1), shard.size()); }),
              testing::HasSubstr("checksum"));
}

TEST(Shard, RefusesARangeThatLeadsOutOfTheShard) {
  const Bytes shard = encode_shard({filled(5, 1)});
  // The same index, with its good checksum, on a shard that lost a byte of its chunk.
  EXPECT_THAT(
      message_of<SampleError>([&] { parse_shard_index(index_of(shard, 1), shard.size() - 1); }),
      testing::HasSubstr("leads out"));
}

}  // namespace
}  // namespace biotomy::reconstruct
