#include "reconstruct/store/volume.hpp"

#include <array>
#include <fstream>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/shard.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "reconstruct/store/zarr_array.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using tests::TemporaryFolder;

class VolumeOnDisk : public testing::Test {
 protected:
  VolumeOnDisk() {
    VolumeLayout layout;
    layout.chunk = {4, 8, 8};
    layout.shard = {4, 16, 16};
    VolumeWriter(sample_, layout).append(8, false);
  }

  Volume open() const { return Volume::open(sample_.volume_path()); }
  std::string error_of_reading(ChunkIndex chunk) const {
    return message_of<SampleError>([&] { open().read_chunk(0, chunk); });
  }
  std::string error_of_opening() const {
    return message_of<SampleError>([&] { open(); });
  }

  TemporaryFolder folder_;
  SampleFolder sample_ = sample_with_layers(folder_.path() / "s", {30, 20, 8}, 8, 8);
  std::filesystem::path shard_ = sample_.volume_path() / "0" / "c" / "0" / "0" / "0" / "1";
};

TEST_F(VolumeOnDisk, SaysWhatItHolds) {
  const Volume volume = open();
  EXPECT_EQ(volume.cuboid().size, (GridSize{30, 20, 8}));
  EXPECT_EQ(volume.cuboid().spacing, (Vector3{10.0, 11.0, 50.0}));
  EXPECT_EQ(volume.bits(), 8);
  EXPECT_EQ(volume.layers_present(), 8);
}

TEST_F(VolumeOnDisk, VoxelsOfAChunkAreInTheirPlaces) {
  const auto voxels = open().read_chunk(0, {1, 1, 2});  // z from 4, y from 8, x from 16
  ASSERT_NE(voxels, nullptr);
  ASSERT_EQ(voxels->size(), 4U * 8 * 8 * 3);
  const cv::Mat layer = test_image(30, 20, CV_8UC3, 7);  // z 6
  const std::size_t place = ((2 * 8 + 3) * 8 + 5) * 3;   // y 11, x 21
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(std::to_integer<int>((*voxels)[place + static_cast<std::size_t>(c)]),
              layer.at<cv::Vec3b>(11, 21)[c]);
  }
}

TEST_F(VolumeOnDisk, OfASampleIsTheOneInItsFolder) {
  EXPECT_EQ(Volume::of_sample(sample_).layers_present(), 8);
  std::filesystem::remove(sample_.volume_path() / "zarr.json");
  EXPECT_THAT(message_of<SampleError>([&] { Volume::of_sample(sample_); }),
              AllOf(HasSubstr("zarr.json"), HasSubstr("is missing")));
}

TEST_F(VolumeOnDisk, OfASampleThatHasNoneYetHasNoLayers) {
  const auto expect_nothing = [&] {
    const Volume volume = Volume::of_sample(sample_);
    EXPECT_EQ(volume.layers_present(), 0);
    EXPECT_EQ(volume.cuboid().size, (GridSize{30, 20, 8}));
    EXPECT_EQ(volume.cuboid().spacing, (Vector3{10.0, 11.0, 50.0}));
    EXPECT_EQ(volume.bits(), 8);
    EXPECT_EQ(volume.read_chunk(0, {0, 0, 0}), nullptr);
  };
  std::filesystem::remove_all(sample_.volume_path());
  expect_nothing();
  // A writer has begun it: the arrays are there, the group is not.
  VolumeWriter(sample_, VolumeLayout{});
  std::filesystem::remove(sample_.volume_path() / "zarr.json");
  expect_nothing();
}

TEST_F(VolumeOnDisk, CountsWhatReadingCosts) {
  const Volume volume = open();
  volume.read_chunk(0, {0, 0, 0});
  volume.read_chunk(0, {0, 0, 1});
  EXPECT_EQ(volume.statistics().chunks_read, 2);
  EXPECT_GT(volume.statistics().bytes_read, 0);
  EXPECT_GT(volume.statistics().decode_ns, 0);
}

TEST_F(VolumeOnDisk, ReadsTheIndexOfAShardOnce) {
  const Volume volume = open();
  volume.read_chunk(0, {0, 0, 0});
  const auto first = volume.statistics().bytes_read.load();
  volume.read_chunk(0, {0, 0, 0});
  const auto second = volume.statistics().bytes_read.load() - first;
  EXPECT_EQ(first - second, 4 * 16 + 4);
}

TEST_F(VolumeOnDisk, DamagedIndexNamesTheShard) {
  flip_byte(shard_, std::filesystem::file_size(shard_) - 10);
  EXPECT_THAT(error_of_reading({0, 0, 2}),
              AllOf(StartsWith(shard_.string()), HasSubstr("checksum of its index")));
  EXPECT_NO_THROW(open().read_chunk(0, {0, 0, 0}));  // the other shards are as good as before
}

TEST_F(VolumeOnDisk, DamagedChunkNamesTheShardAndTheChunk) {
  flip_byte(shard_, 40);
  EXPECT_THAT(error_of_reading({0, 0, 2}),
              AllOf(StartsWith(shard_.string()), HasSubstr("chunk z 0, y 0, x 2 is damaged")));
}

TEST_F(VolumeOnDisk, TruncatedShardIsAnError) {
  truncate_file(shard_, 0.7);
  EXPECT_THAT(error_of_reading({0, 0, 2}), StartsWith(shard_.string()));
  truncate_file(shard_, 0.0);
  EXPECT_THAT(error_of_reading({0, 0, 2}), HasSubstr("shorter than its index"));
}

TEST_F(VolumeOnDisk, AMissingShardOfAnyLevelIsNamed) {
  for (int level = 0; level < open().levels(); ++level) {
    const auto shard = sample_.volume_path() / std::to_string(level) / "c" / "0" / "0" / "0" / "0";
    ASSERT_TRUE(std::filesystem::remove(shard));
    const std::string expected = shard.string() + ": is missing";
    EXPECT_THAT(message_of<SampleError>([&] {
                  open().read_chunk(level, {0, 0, 0});
                }),
                StartsWith(expected));
    std::vector<std::string> heard;
    const std::array<ChunkIndex, 1> wanted{ChunkIndex{0, 0, 0}};
    open().read_chunks(
        level, wanted, [](auto, auto) { ADD_FAILURE() << "there is no such chunk"; },
        [&](std::size_t, const SampleError& error) { heard.emplace_back(error.what()); });
    EXPECT_THAT(heard, testing::ElementsAre(StartsWith(expected)));
  }
}

TEST_F(VolumeOnDisk, AMissingShardIsFillValueWhereNoLayerIsYet) {
  const auto growing = sample_with_layers(folder_.path() / "g", {30, 20, 16}, 8, 8);
  VolumeWriter(growing, open().layout()).append(8, false);
  const Volume volume = Volume::open(growing.volume_path());
  EXPECT_NE(volume.read_chunk(0, {1, 0, 0}), nullptr);
  EXPECT_EQ(volume.read_chunk(0, {2, 0, 0}), nullptr);  // z from 8
}

TEST_F(VolumeOnDisk, AMissingShardIsFillValueWhereNotEveryOneIsStored) {
  const auto group = sample_.volume_path() / "zarr.json";
  const auto text = read_file(group);
  VolumeMetadata metadata = parse_group_metadata(
      {reinterpret_cast<const char*>(text.data()), text.size()}, group.string());
  metadata.every_shard = false;
  write_text(group, group_metadata(metadata));
  std::filesystem::remove(shard_);
  EXPECT_EQ(open().read_chunk(0, {0, 0, 2}), nullptr);
  EXPECT_NE(open().read_chunk(0, {0, 0, 0}), nullptr);
}

TEST_F(VolumeOnDisk, AShardOfManyHolesCostsNoMemory) {
  const auto whole = read_file(shard_);
  const std::size_t index_bytes = shard_index_bytes(4);
  std::filesystem::resize_file(shard_, std::uintmax_t{1} << 40);
  std::ofstream(shard_, std::ios::binary | std::ios::app)
      .write(reinterpret_cast<const char*>(whole.data() + whole.size() - index_bytes),
             static_cast<std::streamsize>(index_bytes));
  EXPECT_NE(open().read_chunk(0, {0, 0, 2}), nullptr);
}

TEST_F(VolumeOnDisk, ReadsAWholeOldOrNewChunkThoughItsShardIsReplacedMeanwhile) {
  const auto old_voxels = open().read_chunk(0, {0, 0, 3});
  const Volume volume = open();
  volume.read_chunk(0, {0, 0, 2});  // now it knows the old shard's index
  // Another writer stores the band anew, from layers that compress to other lengths.
  for (std::int64_t layer = 1; layer <= 4; ++layer) {
    write_layer_image(sample_.layer_path(layer), cv::Mat(20, 30, CV_8UC3, cv::Scalar(1, 2, 3)),
                      {layer, {1, 1, 1}}, {});
  }
  const VolumeLayout layout = volume.layout();
  std::filesystem::remove_all(sample_.volume_path());
  VolumeWriter(sample_, layout).append(8, false);
  const auto new_voxels = open().read_chunk(0, {0, 0, 3});
  ASSERT_NE(*old_voxels, *new_voxels);

  const auto voxels = volume.read_chunk(0, {0, 0, 3});
  ASSERT_NE(voxels, nullptr);
  EXPECT_TRUE(*voxels == *old_voxels || *voxels == *new_voxels);
}

TEST_F(VolumeOnDisk, RefusesAFolderThatIsNoVolume) {
  EXPECT_THAT(message_of<SampleError>([&] { Volume::open(folder_.path()); }),
              HasSubstr("there is no volume here"));
  EXPECT_THROW(Volume::open("/nowhere"), SampleError);
}

TEST_F(VolumeOnDisk, RefusesDamagedMetadata) {
  truncate_file(sample_.volume_path() / "0" / "zarr.json", 0.5);
  EXPECT_THAT(error_of_opening(), HasSubstr("0/zarr.json"));
  std::filesystem::remove(sample_.volume_path() / "0" / "zarr.json");
  EXPECT_THAT(error_of_opening(), HasSubstr("is missing"));
  truncate_file(sample_.volume_path() / "zarr.json", 0.5);
  EXPECT_THAT(error_of_opening(), HasSubstr("is not the metadata of a volume"));
}

TEST_F(VolumeOnDisk, NamesTheArrayOfAnyLevelThatIsMissingOrDoesNotFit) {
  for (int level = 0; level < open().levels(); ++level) {
    const auto array = sample_.volume_path() / std::to_string(level) / "zarr.json";
    const auto whole = read_file(array);
    std::filesystem::remove(array);
    EXPECT_THAT(error_of_opening(), StartsWith(array.string() + ": is missing"));
    if (level > 0) {
      write_text(array, array_metadata({{30, 20, 1000}, 8, {}}));
      EXPECT_THAT(error_of_opening(), StartsWith(array.string() + ": does not fit level 0"));
    }
    write_file(array, whole);
  }
  EXPECT_NO_THROW(open());
}

}  // namespace
}  // namespace biotomy::reconstruct
