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

TEST(ZarrArray, IsUnderstoodAsAnotherProgramWritesItAnew) {
  ZarrArray array = example();
  array.bits = 8;
  auto json = nlohmann::json::parse(array_metadata(array));
  json["attributes"] = {{"scanned by", "somebody"}, {"of", {1, 2, 3}}};
  json["storage_transformers"] = nlohmann::json::array();
  // One byte has no order, which some writers then leave out.
  json["codecs"][0]["configuration"]["codecs"][1].erase("configuration");
  EXPECT_EQ(parse_array_metadata(json.dump(), "a"), array);
  json.erase("attributes");
  EXPECT_EQ(parse_array_metadata(json.dump(1, '\t'), "a"), array);
}

TEST(ZarrArray, IsUnderstoodWhateverTheSizeOfBloscsBlocks) {
  nlohmann::json metadata = nlohmann::json::parse(array_metadata({{30, 20, 1000}, 8, {}}));
  nlohmann::json& chunk_codecs = metadata["codecs"][0]["configuration"]["codecs"];
  for (nlohmann::json& codec : chunk_codecs) {
    if (codec["name"] == "blosc") {
      ASSERT_EQ(codec["configuration"]["blocksize"], 8 * 32 * 32 * 3);
      codec["configuration"]["blocksize"] = 0;
    }
  }
  EXPECT_EQ(parse_array_metadata(metadata.dump(), "a").layout, VolumeLayout{});
}

TEST(ZarrArray, RefusesTwoBytesWithoutTheirOrder) {
  auto json = nlohmann::json::parse(array_metadata(example()));
  json["codecs"][0]["configuration"]["codecs"][1].erase("configuration");
  EXPECT_THAT(message_of<SampleError>([&] { parse_array_metadata(json.dump(), "a"); }),
              HasSubstr("codecs are not known"));
}

TEST(ZarrArray, RefusesSizesThatCannotBeMeant) {
  const auto original = nlohmann::json::parse(array_metadata(example()));
  for (const nlohmann::json& size :
       {nlohmann::json(0), nlohmann::json(-1), nlohmann::json(1'000'001),
        nlohmann::json(std::uint64_t{1} << 63), nlohmann::json((std::uint64_t{1} << 32) + 100),
        nlohmann::json(1e300), nlohmann::json(99.5), nlohmann::json("100")}) {
    auto json = original;
    json["shape"][1] = size;
    EXPECT_THAT(
        message_of<SampleError>([&] { parse_array_metadata(json.dump(), "v/0/zarr.json"); }),
        testing::AllOf(StartsWith("v/0/zarr.json: "), HasSubstr("its shape")))
        << size;
  }
}

TEST(ZarrArray, RefusesAShardWhoseIndexWouldFillTheMemory) {
  auto json = nlohmann::json::parse(array_metadata(example()));
  json["chunk_grid"]["configuration"]["chunk_shape"] = {3, 16384, 16384, 16384};
  json["codecs"][0]["configuration"]["chunk_shape"] = {3, 1, 1, 1};
  EXPECT_THAT(message_of<SampleError>([&] { parse_array_metadata(json.dump(), "a"); }),
              HasSubstr("chunks"));
}

TEST(ZarrArray, ShowsOnlyTheBeginningOfCodecsThatItDoesNotKnow) {
  auto json = nlohmann::json::parse(array_metadata(example()));
  json["codecs"][0]["configuration"]["codecs"] =
      nlohmann::json::array({{{"name", std::string(500'000, 'a')}}});
  EXPECT_LT(message_of<SampleError>([&] { parse_array_metadata(json.dump(), "a"); }).size(), 200U);
}

}  // namespace
}  // namespace biotomy::reconstruct
