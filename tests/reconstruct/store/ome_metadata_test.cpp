#include "reconstruct/store/ome_metadata.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"

namespace biotomy::reconstruct {
namespace {

VolumeMetadata example() {
  return {"knee \"042\"", {10.5, 11.0, 50.0}, 16, {{1, 1, 1}, {2, 2, 1}, {4, 4, 2}}, 96};
}

TEST(OmeMetadata, IsUnderstoodAgain) {
  EXPECT_EQ(parse_group_metadata(group_metadata(example()), "g"), example());
}

TEST(OmeMetadata, ScalesAreInTheOrderOfTheAxes) {
  const auto group = nlohmann::json::parse(group_metadata(example()));
  const auto& multiscale = group.at("attributes").at("ome").at("multiscales").at(0);
  EXPECT_EQ(multiscale.at("axes").at(1).at("name"), "z");
  EXPECT_EQ(multiscale.at("axes").at(1).at("unit"), "micrometer");
  const auto& level = multiscale.at("datasets").at(0);
  EXPECT_EQ(level.at("path"), "0");
  EXPECT_EQ(level.at("coordinateTransformations").size(), 1U);
  EXPECT_EQ(level.at("coordinateTransformations").at(0).at("scale"),
            nlohmann::json({1.0, 50.0, 11.0, 10.5}));
}

TEST(OmeMetadata, HigherLevelsLieHalfOfTheirGrowthFurtherIn) {
  const auto group = nlohmann::json::parse(group_metadata(example()));
  const auto& level = group.at("attributes").at("ome").at("multiscales").at(0).at("datasets").at(2);
  const auto& transformations = level.at("coordinateTransformations");
  EXPECT_EQ(transformations.at(0).at("scale"), nlohmann::json({1.0, 100.0, 44.0, 42.0}));
  EXPECT_EQ(transformations.at(1).at("translation"),
            nlohmann::json({0.0, 25.0, 16.5, 15.75}));  // z half a voxel, y and x one and a half
}

TEST(OmeMetadata, RefusesLevelsThatAreNoPowersOfTwo) {
  auto group = nlohmann::json::parse(group_metadata(example()));
  for (const double scale : {60.0, 0.0, -50.0, 25.0, 1e300}) {
    group["attributes"]["ome"]["multiscales"][0]["datasets"][1]["coordinateTransformations"][0]
         ["scale"][1] = scale;
    EXPECT_THROW(parse_group_metadata(group.dump(), "g"), SampleError) << scale;
  }
}

TEST(OmeMetadata, RefusesLevelsByOtherNames) {
  auto group = nlohmann::json::parse(group_metadata(example()));
  group["attributes"]["ome"]["multiscales"][0]["datasets"][1]["path"] = "../../secret";
  EXPECT_THROW(parse_group_metadata(group.dump(), "g"), SampleError);
}

TEST(OmeMetadata, ShowsTheThreeColoursInTheirFullRange) {
  const auto group = nlohmann::json::parse(group_metadata(example()));
  const auto& attributes = group.at("attributes");
  const auto& channels = attributes.at("ome").at("omero").at("channels");
  ASSERT_EQ(channels.size(), 3U);
  EXPECT_EQ(channels.at(0).at("color"), "FF0000");
  EXPECT_EQ(channels.at(2).at("color"), "0000FF");
  EXPECT_EQ(channels.at(1).at("window").at("end"), 65535);
  EXPECT_EQ(attributes.at("omero"), attributes.at("ome").at("omero"));
}

TEST(OmeMetadata, RefusesAnotherVersion) {
  auto group = nlohmann::json::parse(group_metadata(example()));
  group["attributes"]["ome"]["version"] = "0.4";
  EXPECT_THAT(message_of<SampleError>([&] { parse_group_metadata(group.dump(), "v/zarr.json"); }),
              testing::AllOf(testing::StartsWith("v/zarr.json"), testing::HasSubstr("0.5")));
}

TEST(OmeMetadata, RefusesANegativeNumberOfLayers) {
  auto group = nlohmann::json::parse(group_metadata(example()));
  group["attributes"]["biotomy"]["layers_present"] = -1;
  EXPECT_THROW(parse_group_metadata(group.dump(), "g"), SampleError);
}

TEST(OmeMetadata, ClaimsThatEveryShardIsStoredOnlyWhereItIsSo) {
  VolumeMetadata metadata = example();
  EXPECT_FALSE(nlohmann::json::parse(group_metadata(metadata))
                   .at("attributes")
                   .at("biotomy")
                   .contains("every_shard"));
  metadata.every_shard = true;
  EXPECT_EQ(parse_group_metadata(group_metadata(metadata), "g"), metadata);
  auto group = nlohmann::json::parse(group_metadata(metadata));
  group["attributes"]["biotomy"]["every_shard"] = "yes";
  EXPECT_THROW(parse_group_metadata(group.dump(), "g"), SampleError);
}

TEST(OmeMetadata, ALayerOfALevelIsPresentWithTheFirstThatItIsMadeOf) {
  VolumeMetadata metadata = example();  // factors 1, 1 and 2 along z
  metadata.layers_present = 5;
  EXPECT_EQ(layers_present_at(metadata, 0), 5);
  EXPECT_EQ(layers_present_at(metadata, 1), 5);
  EXPECT_EQ(layers_present_at(metadata, 2), 3);
  metadata.layers_present = 0;
  EXPECT_EQ(layers_present_at(metadata, 2), 0);
}

TEST(OmeMetadata, RefusesAStoreWithoutOurOwnAttributes) {
  auto group = nlohmann::json::parse(group_metadata(example()));
  group["attributes"].erase("biotomy");
  EXPECT_THROW(parse_group_metadata(group.dump(), "g"), SampleError);
}

TEST(OmeMetadata, RefusesALevelThatIsNotCoarser) {
  auto group = nlohmann::json::parse(group_metadata(example()));
  auto& datasets = group["attributes"]["ome"]["multiscales"][0]["datasets"];
  datasets[2]["coordinateTransformations"] = datasets[1]["coordinateTransformations"];
  EXPECT_THAT(message_of<SampleError>([&] { parse_group_metadata(group.dump(), "g"); }),
              testing::HasSubstr("does not halve"));
}

TEST(OmeMetadata, RefusesALevelThatSkipsOne) {
  auto group = nlohmann::json::parse(group_metadata(example()));
  auto& datasets = group["attributes"]["ome"]["multiscales"][0]["datasets"];
  auto& scale = datasets[2]["coordinateTransformations"][0]["scale"];
  scale[3] = 2.0 * scale[3].get<double>();
  EXPECT_THAT(message_of<SampleError>([&] { parse_group_metadata(group.dump(), "g"); }),
              testing::HasSubstr("does not halve"));
}

TEST(OmeMetadata, RefusesSpacingsThatCannotBeMeant) {
  for (const double spacing : {1e300, 1e-300, -1.0, 0.0}) {
    VolumeMetadata metadata = example();
    metadata.levels = {{}};
    metadata.spacing.y = spacing;
    EXPECT_THAT(
        message_of<SampleError>([&] { parse_group_metadata(group_metadata(metadata), "g"); }),
        testing::HasSubstr("spacings"))
        << spacing;
  }
}

TEST(OmeMetadata, RefusesNumbersOfOursThatDoNotFit) {
  const auto original = nlohmann::json::parse(group_metadata(example()));
  for (const auto& [key, value] :
       {std::pair("bits", nlohmann::json((std::uint64_t{1} << 32) + 8)),
        std::pair("bits", nlohmann::json(12)), std::pair("layers_present", nlohmann::json(-1)),
        std::pair("layers_present", nlohmann::json(1e18))}) {
    auto group = original;
    group["attributes"]["biotomy"][key] = value;
    EXPECT_THAT(message_of<SampleError>([&] { parse_group_metadata(group.dump(), "g"); }),
                testing::HasSubstr(key))
        << value;
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
