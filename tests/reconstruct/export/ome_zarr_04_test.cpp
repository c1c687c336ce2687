#include "reconstruct/export/ome_zarr_04.hpp"

#include <cstring>

#include <blosc.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/reconstruct/volume_levels.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using nlohmann::json;

/// Reads an exported array by the words of Zarr v2, chunk by chunk.
class OmeZarr04 : public testing::TestWithParam<int> {
 protected:
  OmeZarr04() {
    layout_.chunk = {4, 8, 16};
    layout_.shard = {8, 16, 32};
    VolumeWriter(sample_, layout_).append(11, true);
    request_.output = folder_ / "out";
  }
  void run() { export_ome_zarr_04(Volume::open(sample_.volume_path()), "knee", request_); }

  json read_json(const std::string& name) const {
    const auto bytes = read_file(request_.output / name);
    return json::parse(reinterpret_cast<const char*>(bytes.data()),
                       reinterpret_cast<const char*>(bytes.data()) + bytes.size());
  }
  std::vector<cv::Mat> read_array(int level) const {
    const std::string folder = std::to_string(level) + "/";
    const json array = read_json(folder + ".zarray");
    EXPECT_EQ(array.at("chunks"), json({1, 64, 64, 64}));
    const auto size = array.at("shape").get<std::vector<int>>();
    const auto value = static_cast<std::size_t>(GetParam() / 8);
    std::vector<cv::Mat> layers(static_cast<std::size_t>(size[1]));
    for (cv::Mat& layer : layers) {
      layer = cv::Mat(size[2], size[3], GetParam() == 8 ? CV_8UC3 : CV_16UC3, cv::Scalar::all(0));
    }
    std::vector<std::byte> chunk(64 * 64 * 64 * value);
    for (int c = 0; c < 3; ++c) {
      for (int z = 0; z < size[1]; ++z) {
        for (int y = 0; y < size[2]; ++y) {
          for (int x = 0; x < size[3]; ++x) {
            if (x % 64 == 0) {
              const auto bytes = read_file(
                  request_.output / (folder + std::to_string(c) + "/" + std::to_string(z / 64) +
                                     "/" + std::to_string(y / 64) + "/" + std::to_string(x / 64)));
              EXPECT_EQ(blosc_decompress_ctx(bytes.data(), chunk.data(), chunk.size(), 1),
                        static_cast<int>(chunk.size()));
            }
            const auto place = static_cast<std::size_t>((z % 64 * 64 + y % 64) * 64 + x % 64);
            std::memcpy(
                layers[static_cast<std::size_t>(z)].ptr(y, x) + static_cast<std::size_t>(c) * value,
                chunk.data() + place * value, value);
          }
        }
      }
    }
    return layers;
  }

  tests::TemporaryFolder folder_;
  SampleFolder sample_ = sample_with_layers(folder_ / "s", {90, 45, 11}, GetParam(), 11);
  VolumeLayout layout_;
  ExportRequest request_;
};

TEST_P(OmeZarr04, HoldsEveryVoxelOfEveryLevel) {
  run();
  const Volume volume = Volume::open(sample_.volume_path());
  ASSERT_GT(volume.levels(), 2);
  ASSERT_EQ(read_json(".zattrs").at("multiscales")[0].at("datasets").size(),
            static_cast<std::size_t>(volume.levels()));
  for (int level = 0; level < volume.levels(); ++level) {
    const auto expected = stored_level(volume, level);
    const auto found = read_array(level);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_TRUE(same_pixels(found[k], expected[k])) << level << ", " << k;
    }
  }
}

TEST_P(OmeZarr04, SaysWhereEveryLevelLies) {
  run();
  EXPECT_EQ(read_json(".zgroup"), json({{"zarr_format", 2}}));
  const json group = read_json(".zattrs");
  const json& image = group.at("multiscales")[0];
  EXPECT_EQ(image.at("version"), "0.4");
  EXPECT_EQ(image.at("name"), "knee");
  EXPECT_EQ(image.at("axes")[1], json({{"name", "z"}, {"type", "space"}, {"unit", "micrometer"}}));
  const json& first = image.at("datasets")[0].at("coordinateTransformations");
  EXPECT_EQ(first[0].at("scale"), json({1.0, 50.0, 11.0, 10.0}));
  EXPECT_EQ(first[1].at("translation"), json({0.0, 0.0, 0.0, 0.0}));
  const json& second = image.at("datasets")[1].at("coordinateTransformations");
  EXPECT_EQ(second[0].at("scale"), json({1.0, 50.0, 22.0, 20.0}));
  EXPECT_EQ(second[1].at("translation"), json({0.0, 0.0, 5.5, 5.0}));
  EXPECT_EQ(group.at("omero").at("channels").size(), 3U);
  EXPECT_EQ(read_json("0/.zarray").at("dtype"), GetParam() == 8 ? "|u1" : "<u2");
}

TEST_P(OmeZarr04, CutsARegionOutOfEveryLevelThatKeepsItsPlace) {
  request_.level = 1;
  request_.region = "5:31,:,3:8";
  run();
  const Volume volume = Volume::open(sample_.volume_path());
  const auto expected = stored_level(volume, 1);
  const auto found = read_array(0);
  ASSERT_EQ(found.size(), 5U);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_TRUE(same_pixels(found[k], expected[k + 3](cv::Rect(5, 0, 26, 23)))) << k;
  }
  const json place =
      read_json(".zattrs").at("multiscales")[0].at("datasets")[0].at("coordinateTransformations");
  EXPECT_EQ(place[1].at("translation"), json({0.0, 150.0, 5.5, 105.0}));
}

TEST_P(OmeZarr04, LeavesNothingWhenAChunkIsDamagedOrItIsInterrupted) {
  request_.stop = [] { return true; };
  EXPECT_THROW(run(), Interrupted);
  request_.stop = {};
  const auto shard = sample_.volume_path() / "0" / "c" / "0" / "1" / "0" / "0";
  flip_byte(shard, 5);
  EXPECT_THAT(message_of<SampleError>([&] { run(); }), testing::HasSubstr(shard.string()));
  EXPECT_THAT(names_in(folder_.path()), testing::ElementsAre("s"));
}

INSTANTIATE_TEST_SUITE_P(Bits, OmeZarr04, testing::Values(8, 16));

}  // namespace
}  // namespace biotomy::reconstruct
