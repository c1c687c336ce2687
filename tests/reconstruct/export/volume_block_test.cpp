#include "reconstruct/export/volume_block.hpp"

#include <gtest/gtest.h>

#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

TEST(AVolumeBlock, IsThatRegionOfEveryLayer) {
  const tests::TemporaryFolder folder;
  const auto sample = sample_with_layers(folder / "s", {50, 40, 20}, 16, 9);
  VolumeLayout layout;
  layout.chunk = {4, 8, 16};
  layout.shard = {4, 16, 32};
  VolumeWriter(sample, layout).append(9, true);
  const Volume volume = Volume::open(sample.volume_path());
  const auto layers = read_block(volume, 0, {{13, 49}, {7, 8}, {3, 12}});
  ASSERT_EQ(layers.size(), 9U);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_TRUE(same_pixels(layers[k], test_image(50, 40, CV_16UC3, k + 4)(cv::Rect(13, 7, 36, 1))))
        << k;
  }
  EXPECT_TRUE(same_pixels(layers[8], cv::Mat(1, 36, CV_16UC3, cv::Scalar::all(0))));
}

}  // namespace
}  // namespace biotomy::reconstruct
