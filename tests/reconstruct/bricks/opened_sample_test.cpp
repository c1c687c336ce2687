#include "reconstruct/bricks/opened_sample.hpp"

#include <filesystem>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

class AnOpenedSample : public testing::Test {
 protected:
  tests::TemporaryFolder folder_;
  SampleFolder sample_ = sample_with_layers(folder_ / "s", {40, 30, 80}, 8, 0);
};

TEST_F(AnOpenedSample, ReachesTheNewestLayerWhetherOrNotItIsInTheVolume) {
  add_layers(sample_, 1, 3);
  {
    const OpenedSample before_the_volume(sample_.path());
    EXPECT_EQ(before_the_volume.volume.layers_present(), 0);
    EXPECT_EQ(before_the_volume.tail.layers_present(), 3);
  }
  add_layers(sample_, 4, 34);
  VolumeWriter(sample_, {}).append(34, false);
  const OpenedSample opened(sample_.path());
  EXPECT_EQ(opened.volume.layers_present(), 32);
  EXPECT_EQ(opened.tail.layers_present(), 34);
}

TEST_F(AnOpenedSample, RefusesSectionsWhenItHasNoLayersYet) {
  const std::string message =
      message_of<SampleError>([&] { OpenedSample(sample_.path()).require_layers(); });
  EXPECT_THAT(message, testing::AllOf(testing::StartsWith(sample_.path().string()),
                                      testing::HasSubstr("no layers yet")));
}

}  // namespace
}  // namespace biotomy::reconstruct
