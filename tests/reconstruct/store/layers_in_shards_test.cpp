#include "reconstruct/store/layers_in_shards.hpp"

#include <gmock/gmock.h>

#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

class LayersInShards : public testing::Test {
 protected:
  LayersInShards() { VolumeWriter(sample_, array_.layout, volume_).append(7, true); }
  std::int64_t layers() const { return layers_in_shards(volume_, array_); }

  tests::TemporaryFolder folder_;
  ZarrArray array_{{40, 30, 15}, 8, {{2, 8, 16}, {4, 16, 32}, true, "zstd1"}};
  SampleFolder sample_ = sample_with_layers(folder_ / "s", array_.size, 8, 7);
  std::filesystem::path volume_ = folder_ / "v";
};

TEST_F(LayersInShards, AreCountedDownToTheDeepestThatIsNotBlack) {
  EXPECT_TRUE(has_shards(volume_));
  EXPECT_EQ(layers(), 7);
  std::filesystem::remove(volume_ / "0/c/0/1/0/1");  // one of four of the deepest band
  EXPECT_EQ(layers(), 7);
}

TEST_F(LayersInShards, AreAllOfABandThatCannotBeRead) {
  truncate_file(volume_ / "0/c/0/1/0/0", 0.5);
  EXPECT_EQ(layers(), 8);
}

TEST_F(LayersInShards, AreAtLeastOneOfTheDeepestBand) {
  for (const char* name : {"0/0", "0/1", "1/0", "1/1"}) {
    std::filesystem::remove(volume_ / "0/c/0/1" / name);
  }
  EXPECT_EQ(layers(), 4);
  const auto black = sample_with_layers(folder_ / "b", array_.size, 8, 0);
  for (std::int64_t layer = 1; layer <= 6; ++layer) {
    write_layer_image(black.layer_path(layer), cv::Mat(30, 40, CV_8UC3, cv::Scalar::all(0)),
                      {layer, black.description().cuboid.spacing}, {});
  }
  VolumeWriter(black, array_.layout, folder_ / "w").append(6, true);
  EXPECT_EQ(layers_in_shards(folder_ / "w", array_), 5);
}

TEST_F(LayersInShards, AreNoneWhereThereIsNoShard) {
  write_text(volume_ / "0/c/0/1/0/.0.1-2", "half");
  write_text(volume_ / "0/c/0/99999999999999999999", "no shard");
  write_text(volume_ / "0/c/0/77", "deeper than the volume");
  EXPECT_EQ(layers(), 7);
  std::filesystem::remove_all(volume_ / "0/c");
  EXPECT_FALSE(has_shards(volume_));
  EXPECT_EQ(layers(), 0);
}

}  // namespace
}  // namespace biotomy::reconstruct
