#include "reconstruct/store/codecs.hpp"

#include <algorithm>
#include <cstring>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/crc32c.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"

namespace biotomy::reconstruct {
namespace {

using Bytes = std::vector<std::byte>;

VolumeLayout layout_of(const std::string& codec, bool interleaved) {
  VolumeLayout layout;
  layout.chunk = {5, 16, 24};
  layout.shard = {5, 16, 24};
  layout.codec = codec;
  layout.interleaved = interleaved;
  return layout;
}

Bytes voxels_of(const VolumeLayout& layout, int bits) {
  const cv::Mat image = test_image(layout.chunk[2], layout.chunk[0] * layout.chunk[1],
                                   bits == 8 ? CV_8UC3 : CV_16UC3);
  Bytes bytes(image.total() * image.elemSize());
  std::memcpy(bytes.data(), image.data, bytes.size());
  return bytes;
}

class EveryCodec : public testing::TestWithParam<std::tuple<std::string, bool, int>> {};

TEST_P(EveryCodec, GivesBackTheSameVoxels) {
  const auto& [name, interleaved, bits] = GetParam();
  const VolumeLayout layout = layout_of(name, interleaved);
  const ChunkCodec codec(layout, bits);
  const Bytes voxels = voxels_of(layout, bits);
  Bytes decoded(codec.chunk_bytes());
  codec.decode(codec.encode(voxels), decoded);
  EXPECT_EQ(decoded, voxels);
}

TEST_P(EveryCodec, DecodesTheLayersThatAreNeeded) {
  const auto& [name, interleaved, bits] = GetParam();
  const VolumeLayout layout = layout_of(name, interleaved);
  const ChunkCodec codec(layout, bits);
  Bytes noise(codec.chunk_bytes());  // which no encoder makes smaller
  cv::Mat row(1, static_cast<int>(noise.size()), CV_8U, noise.data());
  cv::RNG(1).fill(row, cv::RNG::UNIFORM, 0, 256);
  const std::size_t layer_bytes = noise.size() / static_cast<std::size_t>(layout.chunk[0]);
  for (const Bytes& voxels : {voxels_of(layout, bits), noise}) {
    const Bytes encoded = codec.encode(voxels);
    for (int first = 0; first <= layout.chunk[0]; ++first) {
      for (int end = first; end <= layout.chunk[0]; ++end) {
        Bytes room(voxels.size());
        const auto decoded = codec.decode_layers(encoded, {first, end}, room);
        ASSERT_EQ(decoded.size(), voxels.size());
        const auto from =
            static_cast<std::ptrdiff_t>(static_cast<std::size_t>(first) * layer_bytes);
        const auto to = static_cast<std::ptrdiff_t>(static_cast<std::size_t>(end) * layer_bytes);
        EXPECT_TRUE(std::equal(voxels.begin() + from, voxels.begin() + to, decoded.begin() + from))
            << first << " " << end;
      }
    }
  }
}

TEST_P(EveryCodec, RefusesADamagedChunkOfWhichAnyLayersAreNeeded) {
  const auto& [name, interleaved, bits] = GetParam();
  const VolumeLayout layout = layout_of(name, interleaved);
  const ChunkCodec codec(layout, bits);
  Bytes encoded = codec.encode(voxels_of(layout, bits));
  encoded.back() ^= std::byte{1};
  Bytes room(codec.chunk_bytes());
  EXPECT_THROW(codec.decode_layers(encoded, {1, 2}, room), SampleError);
  EXPECT_THROW(codec.decode_layers({}, {1, 2}, room), SampleError);
}

TEST(ChunkCodec, LeavesLayersThatAreNotNeededAlone) {
  VolumeLayout layout = layout_of("blosc-lz4-noshuffle", true);
  layout.chunk = {8, 16, 24};
  const ChunkCodec codec(layout, 8);
  const Bytes encoded = codec.encode(voxels_of(layout, 8));
  Bytes room(codec.chunk_bytes(), std::byte{0xEE});
  codec.decode_layers(encoded, {2, 4}, room);
  const auto layer = static_cast<std::ptrdiff_t>(codec.chunk_bytes() / 8);
  EXPECT_EQ(std::count(room.begin(), room.begin() + 2 * layer, std::byte{0xEE}), 2 * layer);
  EXPECT_EQ(std::count(room.begin() + 4 * layer, room.end(), std::byte{0xEE}), 4 * layer);
}

TEST_P(EveryCodec, RefusesDamagedAndTruncatedBytes) {
  const auto& [name, interleaved, bits] = GetParam();
  const VolumeLayout layout = layout_of(name, interleaved);
  const ChunkCodec codec(layout, bits);
  const Bytes encoded = codec.encode(voxels_of(layout, bits));
  Bytes decoded(codec.chunk_bytes());
  for (const std::size_t place : {std::size_t{0}, encoded.size() / 2, encoded.size() - 1}) {
    Bytes damaged = encoded;
    damaged[place] ^= std::byte{4};
    EXPECT_THROW(codec.decode(damaged, decoded), SampleError) << place;
  }
  for (const std::size_t length : {std::size_t{0}, std::size_t{3}, encoded.size() / 2}) {
    EXPECT_THROW(codec.decode({encoded.data(), length}, decoded), SampleError) << length;
  }
}

INSTANTIATE_TEST_SUITE_P(Codecs, EveryCodec,
                         testing::Combine(testing::ValuesIn(codec_names()), testing::Bool(),
                                          testing::Values(8, 16)),
                         [](const auto& test) {
                           std::string name = std::get<0>(test.param) +
                                              (std::get<1>(test.param) ? "_rgb_" : "_planar_") +
                                              std::to_string(std::get<2>(test.param));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(ChunkCodec, PlanarStoresAllRedBeforeAllGreen) {
  VolumeLayout layout = layout_of("raw", false);
  layout.chunk = {1, 1, 2};
  const Bytes voxels{std::byte{1}, std::byte{2}, std::byte{3},
                     std::byte{4}, std::byte{5}, std::byte{6}};
  const Bytes encoded = ChunkCodec(layout, 8).encode(voxels);
  const Bytes expected{std::byte{1}, std::byte{4}, std::byte{2},
                       std::byte{5}, std::byte{3}, std::byte{6}};
  EXPECT_EQ(Bytes(encoded.begin(), encoded.begin() + 6), expected);
}

TEST(ChunkCodec, RefusesAWellFormedChunkOfAnotherSize) {
  const VolumeLayout small = layout_of("zstd1", true);
  VolumeLayout large = small;
  large.chunk = {10, 16, 24};
  const Bytes encoded = ChunkCodec(large, 8).encode(voxels_of(large, 8));
  const ChunkCodec codec(small, 8);
  Bytes decoded(codec.chunk_bytes());
  EXPECT_THROW(codec.decode(encoded, decoded), SampleError);
}

TEST(CodecChain, IsWrittenAsZarrSpecifies) {
  const nlohmann::json expected = nlohmann::json::parse(R"([
    {"name": "transpose", "configuration": {"order": [1, 2, 3, 0]}},
    {"name": "bytes", "configuration": {"endian": "little"}},
    {"name": "blosc", "configuration": {"cname": "lz4", "clevel": 5, "shuffle": "bitshuffle",
                                        "typesize": 1, "blocksize": 2304}},
    {"name": "crc32c"}])");
  EXPECT_EQ(codec_chain(layout_of("blosc-lz4-bitshuffle", true), 8), expected);
}

TEST(CodecChain, OfPlanarZstdHasNoTranspose) {
  const nlohmann::json expected = nlohmann::json::parse(R"([
    {"name": "bytes", "configuration": {"endian": "little"}},
    {"name": "zstd", "configuration": {"level": 1, "checksum": false}},
    {"name": "crc32c"}])");
  EXPECT_EQ(codec_chain(layout_of("zstd1", false), 16), expected);
}

TEST(CodecNames, OneThatIsNotKnownIsRefusedWithThoseThatAre) {
  EXPECT_THAT(message_of<InvalidRequest>([] { check_codec_name("lzma"); }),
              testing::AllOf(testing::HasSubstr("lzma"), testing::HasSubstr("zstd1")));
}

/// The bytes with their checksum, as if a writer had meant them.
Bytes with_checksum(Bytes bytes) {
  const std::uint32_t crc = crc32c(bytes);
  for (int shift = 0; shift < 32; shift += 8) {
    bytes.push_back(static_cast<std::byte>(crc >> shift));
  }
  return bytes;
}

TEST_P(EveryCodec, RefusesAWellMeantChunkThatClaimsGigabytes) {
  const auto& [name, interleaved, bits] = GetParam();
  const VolumeLayout layout = layout_of(name, interleaved);
  const ChunkCodec codec(layout, bits);
  Bytes decoded(codec.chunk_bytes());
  // Blosc's header: decoded, block and encoded size in bytes 4 to 15, little-endian. zstd's: the
  // magic number, a descriptor that lets eight bytes of content size follow, those.
  Bytes blosc(64);
  blosc[0] = std::byte{2};
  blosc[1] = std::byte{1};
  blosc[3] = std::byte{1};
  for (const std::size_t place : {7, 11}) {
    blosc[place] = std::byte{0x7F};
  }
  blosc[12] = std::byte{64};
  Bytes zstd(64);
  for (const auto& [place, value] : {std::pair(0, 0x28), std::pair(1, 0xB5), std::pair(2, 0x2F),
                                     std::pair(3, 0xFD), std::pair(4, 0xE0), std::pair(9, 0x10)}) {
    zstd[static_cast<std::size_t>(place)] = static_cast<std::byte>(value);
  }
  for (const Bytes& bomb : {blosc, zstd}) {
    EXPECT_THROW(codec.decode(with_checksum(bomb), decoded), SampleError);
  }
}

TEST(ChunkCodec, RefusesAChunkOfAnotherCompressor) {
  const VolumeLayout layout = layout_of("blosc-lz4-noshuffle", true);
  VolumeLayout other = layout;
  other.codec = "blosc-zstd1-noshuffle";
  const Bytes encoded = ChunkCodec(other, 8).encode(voxels_of(other, 8));
  const ChunkCodec codec(layout, 8);
  Bytes decoded(codec.chunk_bytes());
  EXPECT_THROW(codec.decode(encoded, decoded), SampleError);
}

TEST(ChunkCodec, NeverEncodesMoreThanItSays) {
  for (const std::string& name : codec_names()) {
    VolumeLayout layout = layout_of(name, true);
    for (const std::array<int, 3>& chunk : {std::array{1, 1, 1}, std::array{5, 16, 24}}) {
      layout.chunk = layout.shard = chunk;
      const ChunkCodec codec(layout, 16);
      Bytes noise(codec.chunk_bytes());
      cv::Mat over(1, static_cast<int>(noise.size()), CV_8U, noise.data());
      cv::randu(over, 0, 256);
      EXPECT_LE(codec.encode(noise).size(), codec.longest_encoded()) << name;
    }
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
