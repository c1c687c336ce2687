#include "reconstruct/store/codecs.hpp"

#include <algorithm>
#include <cstring>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "reconstruct/errors.hpp"
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
                                        "typesize": 1, "blocksize": 0}},
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

}  // namespace
}  // namespace biotomy::reconstruct
