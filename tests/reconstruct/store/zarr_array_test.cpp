#include "reconstruct/store/zarr_array.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

ZarrArray example() {
  return {{5000, 3000, 100}, 16, {}};
}

TEST(ZarrArray, IsUnderstoodAgain) {
  for (const int bits : {8, 16}) {
    for (const bool interleaved : {true, false}) {
      ZarrArray array = example();
      array.bits = bits;
      array.layout.interleaved = interleaved;
      array.layout.codec = "blosc-zstd1-shuffle";
      EXPECT_EQ(parse_array_metadata(array_metadata(array), "a"), array);
    }
  }
}

TEST(ZarrArray, SaysWhatZarrReadersLookFor) {
  const auto json = nlohmann::json::parse(array_metadata(example()));
  EXPECT_EQ(json.at("shape"), nlohmann::json({3, 100, 3000, 5000}));
  EXPECT_EQ(json.at("data_type"), "uint16");
  EXPECT_EQ(json.at("fill_value"), 0);
  EXPECT_EQ(json.at("dimension_names"), nlohmann::json({"c", "z", "y", "x"}));
  EXPECT_EQ(json.at("chunk_grid").at("configuration").at("chunk_shape"),
            nlohmann::json({3, 32, 1024, 1024}));
  const auto& sharding = json.at("codecs").at(0).at("configuration");
  EXPECT_EQ(sharding.at("chunk_shape"), nlohmann::json({3, 32, 32, 32}));
  EXPECT_EQ(sharding.at("index_location"), "end");
}

TEST(ZarrArray, CountsShardsUpToTheBorder) {
  const BlockCount shards = shards_of(example());
  EXPECT_EQ(shards.z, 4);
  EXPECT_EQ(shards.y, 3);
  EXPECT_EQ(shards.x, 5);
  EXPECT_EQ(chunks_of_shard({}).total(), 32 * 32);
}

TEST(ZarrArray, ShardKeysFollowTheDefaultEncoding) {
  EXPECT_EQ(shard_key(1, 2, 3), "c/0/1/2/3");
}

TEST(ZarrArray, RefusesWhatIsNotJson) {
  EXPECT_THAT(message_of<SampleError>([] { parse_array_metadata("{", "v/0/zarr.json"); }),
              StartsWith("v/0/zarr.json: is not the metadata"));
}

TEST(ZarrArray, RefusesAMissingField) {
  auto json = nlohmann::json::parse(array_metadata(example()));
  json.erase("shape");
  EXPECT_THROW(parse_array_metadata(json.dump(), "a"), SampleError);
}

TEST(ZarrArray, RefusesCodecsThatItDoesNotKnow) {
  auto json = nlohmann::json::parse(array_metadata(example()));
  json["codecs"][0]["configuration"]["codecs"][0]["name"] = "strange";
  EXPECT_THAT(message_of<SampleError>([&] { parse_array_metadata(json.dump(), "a"); }),
              HasSubstr("strange"));
}

TEST(ZarrArray, RefusesAShardThatDoesNotFitTheChunk) {
  auto json = nlohmann::json::parse(array_metadata(example()));
  json["chunk_grid"]["configuration"]["chunk_shape"] = {3, 32, 1000, 1024};
  EXPECT_THAT(message_of<SampleError>([&] { parse_array_metadata(json.dump(), "a"); }),
              HasSubstr("multiple"));
}

TEST(ZarrArray, RefusesAnotherFillValue) {
  auto json = nlohmann::json::parse(array_metadata(example()));
  json["fill_value"] = 1;
  EXPECT_THROW(parse_array_metadata(json.dump(), "a"), SampleError);
}

}  // namespace
}  // namespace biotomy::reconstruct
