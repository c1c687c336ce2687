#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "reconstruct/bricks/volume_bricks.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/section/section.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
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

TEST(BricksOfASample, GivesTheLayersOfAStoredSampleBackAsSections) {
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
  EXPECT_EQ(volume.statistics().chunks_read, 36)
      << "of two bands those of the first twice: see VolumeBricks";
}

/// A sample that is being photographed, seen in an upright plane.
struct GrowingSample {
  TemporaryFolder folder;
  SampleDescription description = [] {
    SampleDescription growing;
    growing.name = "growing";
    growing.cuboid = {{kLayerSize.width, kLayerSize.height, 24}, {10.0, 10.0, 25.0}};
    growing.created = "2026-01-01T00:00:00Z";
    return growing;
  }();
  SampleFolder sample = SampleFolder::create(folder.path() / "growing", description);
  Plane upright = Plane::from_normal({0, 1, 0}, {0, 100, 0});
  SectionRequest request{upright, section_basis(BasisKind::layer, upright), {}};
  int layers = 0;

  /// Its volume as it is then.
  Volume grow_to(int last) {
    while (layers < last) {
      ++layers;
      write_layer_image(sample.layer_path(layers), layer_image(layers),
                        {layers, description.cuboid.spacing}, {});
    }
    VolumeWriter(sample, small_layout()).append(last, false);
    return Volume::open(sample.volume_path());
  }
};

TEST(BricksOfASample, AreNotReadAgainWhereTheVolumeHasGrownBehindThem) {
  GrowingSample growing;
  const Volume volume = growing.grow_to(12);
  const LayerTail tail(growing.sample, volume);
  VolumeBricks bricks(volume, 10'000'000, {}, &tail);
  cut_section(bricks, growing.request);
  ASSERT_EQ(volume.layers_present(), 8);

  const Volume grown = growing.grow_to(20);
  ASSERT_EQ(grown.layers_present(), 16);
  const LayerTail grown_tail(growing.sample, grown);
  VolumeBricks after(grown, 10'000'000, {}, &grown_tail, bricks);
  VolumeBricks anew(grown, 10'000'000, {}, &grown_tail);
  const cv::Mat image = cut_section(after, growing.request).image;
  EXPECT_EQ(grown.statistics().chunks_read, 4) << "those of layers 9 to 16";
  EXPECT_EQ(cv::norm(image, cut_section(anew, growing.request).image, cv::NORM_INF), 0.0);
}

// As after a rebuild from fewer layers.
TEST(BricksOfASample, AreNotTakenOverFromALongerVolume) {
  GrowingSample before;
  GrowingSample made_anew;
  const Volume longer = before.grow_to(16);
  const Volume shorter = made_anew.grow_to(8);
  VolumeBricks bricks(longer, 10'000'000);
  const cv::Mat all = cut_section(bricks, before.request).image;
  VolumeBricks fresh(shorter, 10'000'000);
  const cv::Mat expected = cut_section(fresh, before.request).image;
  ASSERT_FALSE(same_pixels(expected, all)) << "it has nothing of layers 9 to 16";
  VolumeBricks after(shorter, 10'000'000, {}, nullptr, bricks);
  EXPECT_TRUE(same_pixels(cut_section(after, before.request).image, expected));
}

/// A sample whose volume ends before its layers do, beside the same one with a whole volume.
class VolumeWithATail : public testing::TestWithParam<int> {
 protected:
  static constexpr GridSize kSize{60, 44, 24};
  static constexpr std::int64_t kInVolume = 8;
  static constexpr std::int64_t kOnDisk = 15;
  static constexpr std::size_t kCacheBytes = 1'000'000;

  VolumeWithATail() {
    VolumeLayout layout;
    layout.chunk = {4, 16, 16};
    layout.shard = {8, 32, 32};
    VolumeWriter(finished_, layout).append(kOnDisk, true);
    VolumeWriter(sample_, layout).append(kOnDisk, false);
  }

  static SectionRequest request(const Vector3& normal, const Vector3& point, Interpolation kind,
                                double pixel) {
    const Plane plane = Plane::from_normal(normal, point);
    SectionRequest asked{plane, section_basis(BasisKind::layer, plane), {}};
    asked.style.interpolation = kind;
    asked.style.pixel = pixel;
    return asked;
  }

  tests::TemporaryFolder folder_;
  SampleFolder sample_ = sample_with_layers(folder_ / "live", kSize, GetParam(), kOnDisk);
  SampleFolder finished_ = sample_with_layers(folder_ / "finished", kSize, GetParam(), kOnDisk);
};

TEST_P(VolumeWithATail, GivesTheSectionsOfTheVolumeThatHoldsTheSameLayers) {
  const Volume volume = Volume::of_sample(sample_);
  const Volume whole = Volume::of_sample(finished_);
  ASSERT_EQ(volume.layers_present(), kInVolume);
  const LayerTail tail(sample_, volume);
  VolumeBricks live(volume, kCacheBytes, {}, &tail);
  VolumeBricks expected(whole, kCacheBytes);
  const Vector3 spacing = volume.cuboid().spacing;
  const Vector3 point{30 * spacing.x, 20 * spacing.y, 11 * spacing.z};
  int levels_read = 0;
  for (const Vector3& normal : {Vector3{0, 0, 1}, Vector3{0, 1, 0}, Vector3{1, 0, 0},
                                Vector3{1, 2, 3}, Vector3{3, -1, 0}}) {
    for (const Interpolation kind :
         {Interpolation::nearest, Interpolation::linear, Interpolation::cubic}) {
      for (const double pixel : {7.0, 10.0, 33.0}) {
        const SectionRequest asked = request(normal, point, kind, pixel);
        std::array<std::int64_t, 2> rows{};
        const Section section =
            cut_section(live, asked, [&](std::int64_t done, std::int64_t total) {
              rows = {done, total};
            });
        const std::int64_t all =
            std::int64_t{section.image.rows} * std::ssize(section.statistics.levels);
        EXPECT_EQ(rows, (std::array<std::int64_t, 2>{all, all}));
        EXPECT_TRUE(same_pixels(section.image, cut_section(expected, asked).image))
            << normal.x << normal.y << normal.z << " " << pixel;
        levels_read = std::max(levels_read, section.statistics.levels.back() + 1);
      }
    }
  }
  EXPECT_GT(levels_read, 2);
}

TEST_P(VolumeWithATail, ReachesTheNewestFace) {
  const Volume volume = Volume::of_sample(sample_);
  const LayerTail tail(sample_, volume);
  VolumeBricks source(volume, kCacheBytes, {}, &tail);
  const Vector3 newest{0, 0, static_cast<double>(kOnDisk - 1) * volume.cuboid().spacing.z};
  const SectionRequest asked = request({0, 0, 1}, newest, Interpolation::linear, 10.0);
  const cv::Mat face = read_layer_image(sample_.layer_path(kOnDisk));
  // Voxels are 11 µm high: rows fall on pixels where the picture begins, and eleven pixels on.
  const cv::Mat image = cut_section(source, asked).image;
  EXPECT_TRUE(same_pixels(image.row(0), face.row(0)));
  EXPECT_TRUE(same_pixels(image.row(11), face.row(10)));
}

TEST_P(VolumeWithATail, KeepsWhatItMadeOfTheTail) {
  const Volume volume = Volume::of_sample(sample_);
  const LayerTail tail(sample_, volume);
  VolumeBricks source(volume, kCacheBytes, {}, &tail);
  const SectionRequest asked = request({0, 0, 1}, {0, 0, 500}, Interpolation::linear, 10.0);
  const cv::Mat first = cut_section(source, asked).image;
  for (std::int64_t layer = kInVolume + 1; layer <= kOnDisk; ++layer) {
    std::filesystem::remove(sample_.layer_path(layer));
  }
  EXPECT_TRUE(same_pixels(cut_section(source, asked).image, first));  // from the cache
}

TEST_P(VolumeWithATail, MakesAChunkOfTheTailForAllPlanesAtOnce) {
  const Volume volume = Volume::of_sample(sample_);
  const Volume whole = Volume::of_sample(finished_);
  const LayerTail tail(sample_, volume);
  VolumeBricks source(volume, kCacheBytes, {}, &tail);
  VolumeBricks expected(whole, kCacheBytes);
  const auto layer_from = [&](VolumeBricks& bricks, std::int64_t layer) {
    const Vector3 point{0, 0, static_cast<double>(layer) * volume.cuboid().spacing.z};
    return cut_section(bricks, request({0, 0, 1}, point, Interpolation::linear, 10.0)).image;
  };
  layer_from(source, kInVolume);  // the first layer of a chunk, which has four
  for (std::int64_t layer = kInVolume + 1; layer <= kOnDisk; ++layer) {
    std::filesystem::remove(sample_.layer_path(layer));
  }
  EXPECT_TRUE(same_pixels(layer_from(source, kInVolume + 3), layer_from(expected, kInVolume + 3)));
}

TEST_P(VolumeWithATail, PaintsWhatADamagedLayerTakesAlongWhenThatIsTolerated) {
  const Volume volume = Volume::of_sample(sample_);
  const LayerTail tail(sample_, volume);
  truncate_file(sample_.layer_path(kInVolume + 1), 0.3);
  const SectionRequest asked = request({0, 0, 1}, {0, 0, 8 * 50.0}, Interpolation::nearest, 10.0);
  VolumeBricks strict(volume, kCacheBytes, {}, &tail);
  EXPECT_THROW(cut_section(strict, asked), SampleError);

  VolumeBricks tolerant(volume, kCacheBytes, {true, {1, 2, 3}}, &tail);
  const cv::Mat image = cut_section(tolerant, asked).image;
  const double scale = GetParam() == 8 ? 1.0 : 257.0;
  EXPECT_TRUE(same_pixels(image, cv::Mat(image.size(), image.type(), scale * cv::Scalar(1, 2, 3))));
  EXPECT_EQ(tolerant.damage().chunks, 12);  // of 60 × 44 voxels
  EXPECT_NE(tolerant.damage().first.find("000009.tif"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(, VolumeWithATail, testing::Values(8, 16),
                         [](const auto& bits) { return std::to_string(bits.param) + "Bits"; });

/// A block of which few layers are ground, beside one that was no deeper. Of either the pictures
/// must be the same down to the newest face.
class PartlyGroundBlock : public testing::TestWithParam<int> {
 protected:
  static constexpr std::size_t kCacheBytes = 100'000'000;

  SampleFolder block(const char* name, int depth) const {
    return sample_with_layers(folder_ / name, {128, 128, depth}, 8, GetParam(), {10, 10, 10});
  }

  void expect_the_pictures_of_a_shallow_block(VolumeBricks& deep) {
    const SampleFolder sample = block("shallow", GetParam());
    VolumeWriter(sample, {}).append(GetParam(), true);
    const Volume volume = Volume::of_sample(sample);
    VolumeBricks shallow(volume, kCacheBytes);
    ASSERT_EQ(deep.layers_present(), GetParam());
    ASSERT_EQ(deep.levels(), 3);
    const Vector3 newest{0, 640, 10.0 * (GetParam() - 1)};
    for (const Vector3& normal : {Vector3{0, 0, 1}, Vector3{0, 1, 0}, Vector3{0, 3, 1}}) {
      for (const Interpolation kind :
           {Interpolation::nearest, Interpolation::linear, Interpolation::cubic}) {
        for (const double pixel : {10.0, 14.0, 20.0, 40.0, 80.0}) {
          const Plane plane = Plane::from_normal(normal, newest);
          SectionRequest asked{plane, section_basis(BasisKind::layer, plane), {}};
          asked.style.interpolation = kind;
          asked.style.pixel = pixel;
          const cv::Mat expected = cut_section(shallow, asked).image;
          const cv::Mat image = cut_section(deep, asked).image;
          ASSERT_EQ(image.cols, expected.cols);
          ASSERT_GE(image.rows, expected.rows);
          // The planes of both blocks are the same but for the last bits of their corners.
          EXPECT_LE(cv::norm(image.rowRange(0, expected.rows), expected, cv::NORM_INF), 1.0)
              << normal.y << normal.z << " " << static_cast<int>(kind) << " " << pixel;
          if (image.rows > expected.rows) {
            EXPECT_EQ(cv::norm(image.rowRange(image.rows / 2, image.rows), cv::NORM_INF), 0.0)
                << "what is not ground is black";
          }
        }
      }
    }
  }

  tests::TemporaryFolder folder_;
};

TEST_P(PartlyGroundBlock, IsNotDarkenedAboveItsNewestFaceWhereItIsReadFromImages) {
  const SampleFolder sample = block("deep", 128);
  const Volume volume = Volume::of_sample(sample);
  ASSERT_EQ(volume.layers_present(), 0);
  const LayerTail tail(sample, volume);
  VolumeBricks bricks(volume, kCacheBytes, {}, &tail);
  expect_the_pictures_of_a_shallow_block(bricks);
}

TEST_P(PartlyGroundBlock, IsNotDarkenedAboveItsNewestFaceWhereTheVolumeOfAnAbortedJobHoldsIt) {
  const SampleFolder sample = block("deep", 128);
  VolumeWriter(sample, {}).append(GetParam(), true);
  const Volume volume = Volume::of_sample(sample);
  VolumeBricks bricks(volume, kCacheBytes);
  expect_the_pictures_of_a_shallow_block(bricks);
}

// Whole voxels of each level, and such that some of its last voxel is not ground.
INSTANTIATE_TEST_SUITE_P(, PartlyGroundBlock, testing::Values(8, 7, 5), [](const auto& layers) {
  return std::to_string(layers.param) + "Layers";
});

TEST(BricksOfASample, GivesAColourForWhatIsDamagedWhenItIsToleratedAndCountsEachChunkOnce) {
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
