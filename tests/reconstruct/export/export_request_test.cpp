#include "reconstruct/export/export_request.hpp"

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

}  // namespace
}  // namespace biotomy::reconstruct
