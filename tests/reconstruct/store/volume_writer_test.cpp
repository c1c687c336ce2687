#include "reconstruct/store/volume_writer.hpp"

#include <tuple>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/shard.hpp"
#include "reconstruct/store/volume.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/reconstruct/volume_levels.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;
using tests::TemporaryFolder;

VolumeLayout small_layout() {
  VolumeLayout layout;
  layout.chunk = {4, 16, 8};
  layout.shard = {8, 32, 48};
  return layout;
}

cv::Mat layer_of(const Volume& volume, std::int64_t layer) {
  return stored_level(volume, 0).at(static_cast<std::size_t>(layer - 1));
}

cv::Mat expected_layer(const GridSize& size, int bits, std::int64_t layer) {
  return test_image(static_cast<int>(size.x), static_cast<int>(size.y),
                    bits == 8 ? CV_8UC3 : CV_16UC3, static_cast<std::uint64_t>(layer));
}

class EveryVolume : public testing::TestWithParam<std::tuple<bool, int>> {};

TEST_P(EveryVolume, HoldsEveryVoxelOfEveryLayer) {
  const auto& [interleaved, bits] = GetParam();
  const TemporaryFolder folder;
  const GridSize size{100, 70, 19};
  const auto sample = sample_with_layers(folder.path() / "s", size, bits, 19);
  VolumeLayout layout = small_layout();
  layout.interleaved = interleaved;
  VolumeWriter(sample, layout).append(19, false);
  const Volume volume = Volume::open(sample.volume_path());
  EXPECT_EQ(volume.layout(), layout);
  EXPECT_EQ(volume.layers_present(), 19);
  for (std::int64_t layer = 1; layer <= 19; ++layer) {
    ASSERT_TRUE(same_pixels(layer_of(volume, layer), expected_layer(size, bits, layer))) << layer;
  }
}

INSTANTIATE_TEST_SUITE_P(Layouts, EveryVolume,
                         testing::Combine(testing::Bool(), testing::Values(8, 16)));

class Writer : public testing::Test {
 protected:
  VolumeMetadata group() const {
    const auto text = read_file(sample_.volume_path() / "zarr.json");
    return parse_group_metadata({reinterpret_cast<const char*>(text.data()), text.size()},
                                "zarr.json");
  }
  std::int64_t present() const { return Volume::open(sample_.volume_path()).layers_present(); }
  bool layer_is_right(std::int64_t layer) const {
    return same_pixels(layer_of(Volume::open(sample_.volume_path()), layer),
                       expected_layer(size_, 8, layer));
  }

  TemporaryFolder folder_;
  GridSize size_{50, 40, 20};
  SampleFolder sample_ = sample_with_layers(folder_.path() / "s", size_, 8, 20);
};

TEST_F(Writer, WritesOnlyBandsThatAreComplete) {
  VolumeWriter writer(sample_, small_layout());
  EXPECT_EQ(present(), 0);
  writer.append(7, false);
  EXPECT_EQ(present(), 0);
  std::vector<std::int64_t> progress;
  writer.append(17, false, [&](std::int64_t layers) { progress.push_back(layers); });
  EXPECT_EQ(present(), 16);
  EXPECT_THAT(progress, testing::ElementsAre(8, 16));
  EXPECT_TRUE(layer_is_right(16));
}

TEST_F(Writer, WritesAnIncompleteBandToFinishAndLeavesTheRestFillValue) {
  VolumeWriter writer(sample_, small_layout());
  writer.append(11, true);
  EXPECT_EQ(present(), 11);
  EXPECT_TRUE(layer_is_right(11));
  const cv::Mat absent = layer_of(Volume::open(sample_.volume_path()), 12);
  EXPECT_EQ(cv::countNonZero(absent.reshape(1)), 0);
}

TEST_F(Writer, GoesOnWithAStoreThatIsThereAndKeepsItsLayout) {
  VolumeWriter(sample_, small_layout()).append(11, true);
  VolumeLayout other = small_layout();
  other.codec = "raw";
  VolumeWriter writer(sample_, other);
  EXPECT_EQ(writer.layers_written(), 11);
  writer.append(20, false);
  EXPECT_EQ(present(), 20);
  EXPECT_EQ(Volume::open(sample_.volume_path()).layout(), small_layout());
  for (std::int64_t layer = 1; layer <= 20; ++layer) {
    ASSERT_TRUE(layer_is_right(layer)) << layer;
  }
}

TEST_F(Writer, OverwritesAShardOfABandThatWasInterrupted) {
  VolumeWriter writer(sample_, small_layout());
  const auto shard = sample_.volume_path() / "0" / "c" / "0" / "0" / "0" / "0";
  std::filesystem::create_directories(shard.parent_path());
  write_text(shard, "half a shard");
  writer.append(8, false);
  EXPECT_TRUE(layer_is_right(3));
}

TEST_F(Writer, RemovesWhatAKilledWriterLeftUnfinished) {
  VolumeWriter(sample_, small_layout()).append(8, false);
  const auto shards = sample_.volume_path() / "0" / "c" / "0" / "0";
  write_text(shards / ".0.999999999-3", "half a shard");
  write_text(sample_.volume_path() / ".zarr.json.999999999-4", "half");
  const VolumeWriter writer(sample_, small_layout());
  EXPECT_FALSE(std::filesystem::exists(shards / ".0.999999999-3"));
  EXPECT_FALSE(std::filesystem::exists(sample_.volume_path() / ".zarr.json.999999999-4"));
  EXPECT_EQ(present(), 8);
}

TEST_F(Writer, DoesNotCountABandOfWhichALayerCannotBeRead) {
  truncate_file(sample_.layer_path(12), 0.5);
  VolumeWriter writer(sample_, small_layout());
  EXPECT_THAT(message_of<SampleError>([&] { writer.append(20, false); }), HasSubstr("000012.tif"));
  EXPECT_EQ(present(), 8);
  EXPECT_EQ(writer.layers_written(), 8);
}

TEST_F(Writer, RefusesALayerOfAnotherSize) {
  write_layer_image(sample_.layer_path(3), test_image(51, 40), {3, {1, 1, 1}}, {});
  VolumeWriter writer(sample_, small_layout());
  EXPECT_THAT(message_of<SampleError>([&] { writer.append(8, false); }),
              testing::AllOf(HasSubstr("000003.tif"), HasSubstr("51 × 40")));
}

TEST_F(Writer, RefusesAStoreOfAnotherSample) {
  VolumeWriter(sample_, small_layout()).append(8, false);
  const auto other = sample_with_layers(folder_.path() / "t", {50, 40, 30}, 8, 0);
  std::filesystem::copy(sample_.volume_path(), other.volume_path(),
                        std::filesystem::copy_options::recursive);
  EXPECT_THAT(message_of<SampleError>([&] { VolumeWriter(other, small_layout()); }),
              HasSubstr("does not fit"));
}

TEST_F(Writer, RefusesAStoreOfAnotherSpacing) {
  VolumeWriter(sample_, small_layout()).append(8, false);
  VolumeMetadata metadata = group();
  metadata.spacing.z *= 2.0;
  write_text(sample_.volume_path() / "zarr.json", group_metadata(metadata));
  EXPECT_THAT(message_of<SampleError>([&] { VolumeWriter(sample_, small_layout()); }),
              testing::AllOf(HasSubstr("does not fit"), HasSubstr("spacing_um.z is ")));
}

TEST_F(Writer, RefusesAStoreThatShowsMoreLayersThanTheSampleHas) {
  VolumeWriter(sample_, small_layout()).append(8, false);
  VolumeMetadata metadata = group();
  metadata.layers_present = sample_.description().cuboid.size.z + 1;
  write_text(sample_.volume_path() / "zarr.json", group_metadata(metadata));
  EXPECT_THAT(message_of<SampleError>([&] { VolumeWriter(sample_, small_layout()); }),
              HasSubstr("does not fit"));
}

TEST_F(Writer, RefusesAStoreWithoutItsLevelsAndTellsHowToMendIt) {
  VolumeWriter(sample_, small_layout()).append(8, false);
  VolumeMetadata metadata = group();
  metadata.levels.resize(1);
  write_text(sample_.volume_path() / "zarr.json", group_metadata(metadata));
  EXPECT_THAT(message_of<SampleError>([&] { VolumeWriter(sample_, small_layout()); }),
              HasSubstr("biotomy rebuild " + sample_.path().string()));
}

TEST_F(Writer, KeepsWhatAStoreSaysOfItsShards) {
  VolumeWriter(sample_, small_layout()).append(8, false);
  EXPECT_TRUE(group().every_shard);
  VolumeMetadata older = group();
  older.every_shard = false;
  write_text(sample_.volume_path() / "zarr.json", group_metadata(older));
  VolumeWriter(sample_, small_layout()).append(16, false);
  EXPECT_EQ(group().layers_present, 16);
  EXPECT_FALSE(group().every_shard);
}

TEST_F(Writer, NamesAShardOfAnEarlierBandThatIsLost) {
  VolumeWriter(sample_, small_layout()).append(8, false);
  // The first level that halves z has the second band in the shard of the first.
  const auto levels = group().levels;
  std::size_t halved = 1;
  while (levels[halved].z == 1) ++halved;
  const auto lost = sample_.volume_path() / std::to_string(halved) / "c" / "0" / "0" / "0" / "0";
  ASSERT_TRUE(std::filesystem::remove(lost));
  EXPECT_THAT(
      message_of<SampleError>([&] { VolumeWriter(sample_, small_layout()).append(16, false); }),
      testing::StartsWith(lost.string() + ": is missing"));
  EXPECT_EQ(group().layers_present, 8);
}

TEST_F(Writer, RefusesShardsOfAnOddWidthThatCannotBeHalvedOneByOne) {
  VolumeLayout odd = small_layout();
  odd.chunk = {4, 5, 5};
  odd.shard = {4, 10, 15};
  EXPECT_THAT(message_of<InvalidRequest>([&] { VolumeWriter(sample_, odd); }),
              testing::AllOf(HasSubstr("15,10,4"), HasSubstr("even")));
  EXPECT_FALSE(std::filesystem::exists(sample_.volume_path()));
  odd.shard = {4, 50, 55};  // one shard holds a layer
  EXPECT_NO_THROW(VolumeWriter(sample_, odd).append(8, false));
}

TEST_F(Writer, MakesTheArraysOfAllLevelsWithTheStore) {
  VolumeWriter(sample_, small_layout());
  const Volume volume = Volume::open(sample_.volume_path());
  EXPECT_GT(volume.levels(), 2);
  EXPECT_EQ(volume.read_chunk(volume.levels() - 1, {0, 0, 0}), nullptr);
}

TEST_F(Writer, StoresEveryShardOfItsLayersAlsoOneThatIsAllFillValue) {
  const auto black = sample_with_layers(folder_.path() / "b", {200, 40, 8}, 8, 0);
  for (std::int64_t layer = 1; layer <= 8; ++layer) {
    cv::Mat image(40, 200, CV_8UC3, cv::Scalar::all(0));
    image(cv::Rect(0, 0, 10, 10)).setTo(cv::Scalar::all(9));
    write_layer_image(black.layer_path(layer), image, {layer, {1, 1, 1}}, {});
  }
  VolumeWriter(black, small_layout()).append(8, false);
  const auto rows = black.volume_path() / "0" / "c" / "0" / "0";
  const ZarrArray array{{200, 40, 8}, 8, small_layout()};
  const BlockCount shards = shards_of(array);
  EXPECT_EQ(static_cast<std::int64_t>(names_in(rows).size()), shards.y);
  EXPECT_EQ(static_cast<std::int64_t>(names_in(rows / "0").size()), shards.x);
  EXPECT_EQ(std::filesystem::file_size(rows / "0" / "1"),
            shard_index_bytes(static_cast<std::size_t>(chunks_of_shard(small_layout()).total())));
  EXPECT_EQ(Volume::open(black.volume_path()).read_chunk(0, {0, 0, 2}), nullptr);   // same shard
  EXPECT_EQ(Volume::open(black.volume_path()).read_chunk(0, {0, 2, 24}), nullptr);  // another
}

}  // namespace
}  // namespace biotomy::reconstruct
