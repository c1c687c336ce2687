#include "reconstruct/section/volume_bricks.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/section/section.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::TemporaryFolder;

constexpr int kLayers = 12;
const cv::Size kLayerSize{50, 40};

cv::Mat layer_image(int layer) {
  cv::Mat image(kLayerSize, CV_8UC3);
  cv::RNG random(static_cast<std::uint64_t>(layer));
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

VolumeLayout small_layout() {
  VolumeLayout layout;
  layout.chunk = {8, 16, 16};
  layout.shard = {8, 32, 32};
  return layout;
}

SampleFolder noise_sample(const TemporaryFolder& folder) {
  SampleDescription description;
  description.name = "noise";
  description.cuboid = {{kLayerSize.width, kLayerSize.height, kLayers}, {10.0, 10.0, 25.0}};
  description.created = "2026-01-01T00:00:00Z";
  const SampleFolder sample = SampleFolder::create(folder.path() / "noise", description);
  for (int layer = 1; layer <= kLayers; ++layer) {
    write_layer_image(sample.layer_path(layer), layer_image(layer),
                      {layer, description.cuboid.spacing}, {});
  }
  VolumeWriter(sample, small_layout()).append(kLayers, true);
  return sample;
}

TEST(VolumeAsBricks, GivesTheLayersOfAStoredSampleBackAsSections) {
  const TemporaryFolder folder;
  const SampleFolder sample = noise_sample(folder);
  const Volume volume = Volume::open(sample.volume_path());
  VolumeBricks source(volume, 1'000'000);
  EXPECT_EQ(source.brick_shape(), small_layout().chunk);
  EXPECT_EQ(source.bits(), 8);
  for (int layer = 1; layer <= kLayers; ++layer) {
    const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, (layer - 1) * 25.0});
    const Section section =
        cut_section(source, {plane, section_basis(BasisKind::layer, plane), {}});
    EXPECT_EQ(section.image.size(), kLayerSize);
    EXPECT_EQ(cv::norm(section.image, layer_image(layer), cv::NORM_INF), 0.0) << layer;
    EXPECT_EQ(section.statistics.chunks_touched, 12);
  }
  EXPECT_EQ(volume.statistics().chunks_read, 24);
}

TEST(VolumeAsBricks, GivesAColourForWhatIsDamagedWhenItIsToleratedAndCountsEachChunkOnce) {
  const TemporaryFolder folder;
  const SampleFolder sample = noise_sample(folder);
  const auto shard = sample.volume_path() / "0" / "c" / "0" / "0" / "0" / "1";  // x from 32
  ASSERT_TRUE(std::filesystem::remove(shard));
  const Volume volume = Volume::open(sample.volume_path());
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 25.0});
  const SectionRequest request{plane, section_basis(BasisKind::layer, plane), {}};

  VolumeBricks strict(volume, 1'000'000);
  EXPECT_EQ(message_of<SampleError>([&] { cut_section(strict, request); }).find(shard.string()),
            0U);

  VolumeBricks tolerant(volume, 0, {true, {1, 2, 3}});  // no cache: asked for at each section
  EXPECT_EQ(tolerant.damage().chunks, 0);
  cv::Mat expected = layer_image(2);
  expected(cv::Rect(32, 0, kLayerSize.width - 32, 32)).setTo(cv::Scalar(1, 2, 3));
  for (int time = 0; time < 2; ++time) {
    EXPECT_EQ(cv::norm(cut_section(tolerant, request).image, expected, cv::NORM_INF), 0.0);
  }
  EXPECT_EQ(tolerant.damage().chunks, 4);
  EXPECT_EQ(tolerant.damage().first.find(shard.string() + ": is missing"), 0U);
}

}  // namespace
}  // namespace biotomy::reconstruct
