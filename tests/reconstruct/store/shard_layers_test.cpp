#include "reconstruct/store/shard_layers.hpp"

#include <gtest/gtest.h>

#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

TEST(ShardLayers, AreThoseThatWereWrittenFromAnyLayerOn) {
  const tests::TemporaryFolder folder;
  const auto sample = sample_with_layers(folder / "s", {50, 21, 8}, 16, 8);
  VolumeLayout layout;
  layout.chunk = {4, 8, 8};
  layout.shard = {8, 16, 32};
  VolumeWriter(sample, layout).append(8, true);
  const ZarrArray array{{50, 21, 8}, 16, layout};
  const auto shard =
      StoredShard::open(sample.volume_path() / "0" / "c" / "0" / "0" / "1" / "1", array);
  ASSERT_TRUE(shard);
  const auto layers = shard_layers(shard, array, 3, 4, {18, 5});
  ASSERT_EQ(layers.size(), 4U);
  for (std::size_t k = 0; k < layers.size(); ++k) {
    EXPECT_TRUE(
        same_pixels(layers[k], test_image(50, 21, CV_16UC3, k + 4)(cv::Rect(32, 16, 18, 5))))
        << k;
  }
}

TEST(ShardLayers, AreBlackWhereThereIsNoShard) {
  const auto layers = shard_layers(std::nullopt, {{50, 21, 8}, 8, {}}, 3, 2, {18, 5});
  ASSERT_EQ(layers.size(), 2U);
  EXPECT_TRUE(same_pixels(layers[1], cv::Mat(5, 18, CV_8UC3, cv::Scalar::all(0))));
}

}  // namespace
}  // namespace biotomy::reconstruct
