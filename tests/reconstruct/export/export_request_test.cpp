#include "reconstruct/export/export_request.hpp"

#include <optional>
#include <string>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

TEST(AnExportRequest, IsForTheLayersThatThereAreOfALevelThatThereIs) {
  const tests::TemporaryFolder folder;
  const auto sample = sample_with_layers(folder / "s", {90, 70, 40}, 8, 11);
  VolumeLayout layout;
  layout.chunk = {4, 8, 16};
  layout.shard = {8, 16, 32};
  VolumeWriter writer(sample, layout);
  EXPECT_THAT(
      message_of<SampleError>([&] { exported_region(Volume::open(sample.volume_path()), {}); }),
      testing::HasSubstr("no layers"));
  writer.append(11, true);
  const Volume volume = Volume::open(sample.volume_path());
  ExportRequest request;
  EXPECT_EQ(exported_region(volume, request), (VoxelRegion{{0, 90}, {0, 70}, {0, 11}}));
  request.region = "1:2,3:4,5:";
  EXPECT_EQ(exported_region(volume, request), (VoxelRegion{{1, 2}, {3, 4}, {5, 11}}));
  request.level = volume.levels();
  EXPECT_THAT(message_of<SampleError>([&] { exported_region(volume, request); }),
              testing::HasSubstr("levels 0 to " + std::to_string(volume.levels() - 1)));
}

/// A sample of which 8 layers are in the volume and 3 follow as images.
class LayersLeftOut : public testing::Test {
 protected:
  LayersLeftOut() {
    VolumeLayout layout;
    layout.chunk = {4, 8, 16};
    layout.shard = {8, 16, 32};
    VolumeWriter(sample_, layout).append(11, false);
  }
  std::optional<LayerNumbers> of(const std::string& region, int level = 0) const {
    ExportRequest request;
    request.level = level;
    request.region = region;
    return layers_left_out(sample_, Volume::of_sample(sample_), request);
  }

  const LayerNumbers newest_{9, 11};
  tests::TemporaryFolder folder_;
  SampleFolder sample_ = sample_with_layers(folder_ / "s", {90, 70, 40}, 8, 11, {10, 10, 10});
};

TEST_F(LayersLeftOut, AreThoseThatFollowTheVolumeAsImages) {
  EXPECT_EQ(of(""), newest_);
  EXPECT_EQ(of("", 1), newest_);
  std::filesystem::remove(sample_.layer_path(11));
  EXPECT_EQ(of(""), (LayerNumbers{9, 10}));
  std::filesystem::remove(sample_.layer_path(9));
  EXPECT_EQ(of(""), std::nullopt);
}

TEST_F(LayersLeftOut, AreNoneOfARegionThatEndsInTheVolume) {
  EXPECT_EQ(of("0:1,0:1,0:8"), std::nullopt);
  EXPECT_EQ(of("0:1,0:1,0:9"), newest_);
  EXPECT_EQ(of("0:1,0:1,0:"), newest_);
  EXPECT_EQ(of("0:1,0:1,0:4", 1), std::nullopt);
  EXPECT_EQ(of("0:1,0:1,0:5", 1), newest_);
  EXPECT_THROW(of("0:1,0:1,0:12"), SampleError);
  EXPECT_THROW(of("", 99), SampleError);
}

TEST_F(LayersLeftOut, AreAllWhereThereIsNoVolume) {
  std::filesystem::remove_all(sample_.volume_path());
  EXPECT_EQ(of(""), (LayerNumbers{1, 11}));
}

}  // namespace
}  // namespace biotomy::reconstruct
