#include "reconstruct/store/volume.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <fstream>
#include <mutex>
#include <random>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/shard.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "reconstruct/store/zarr_array.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/reconstruct/watched_reader.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::ElementsAre;
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

TEST_F(VolumeOnDisk, OfASampleFitsItsDescription) {
  replace_text(sample_.path() / "sample.toml", "z = 50.0", "z = 25.0");
  EXPECT_THAT(
      message_of<SampleError>([&] { Volume::of_sample(SampleFolder::open(sample_.path())); }),
      AllOf(StartsWith(sample_.volume_path().string() + ": "),
            HasSubstr("spacing_um.z is 50, in sample.toml 25"), HasSubstr("biotomy rebuild")));
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

/// Many chunks as read_chunks gave them. What came twice, or not, shows.
struct ReadChunks {
  std::vector<int> times;
  std::vector<ChunkVoxels> voxels;
  std::vector<std::string> damage;

  ReadChunks(const Volume& volume, int level, const std::vector<ChunkIndex>& wanted)
      : times(wanted.size()), voxels(wanted.size()), damage(wanted.size()) {
    std::mutex mutex;
    volume.read_chunks(
        level, wanted,
        [&](std::size_t which, std::span<const std::byte> chunk) {
          const std::lock_guard lock(mutex);
          ++times.at(which);
          voxels.at(which).assign(chunk.begin(), chunk.end());
        },
        [&](std::size_t which, const SampleError& error) {
          const std::lock_guard lock(mutex);
          ++times.at(which);
          damage.at(which) = error.what();
        });
  }
};

/// A volume of several bands, shards and levels, whose deepest layers are not there yet. It is
/// written once, and copied for each test.
class ManyChunks : public testing::Test {
 protected:
  static constexpr std::size_t kIndexBytes = 2 * 3 * 16 + 4;  // of a shard

  static void SetUpTestSuite() {
    written_ = std::make_unique<Written>();
    VolumeLayout layout;
    layout.chunk = {4, 8, 8};
    layout.shard = {4, 16, 24};
    VolumeWriter(written_->sample, layout).append(8, false);
  }
  static void TearDownTestSuite() { written_.reset(); }

  ManyChunks() {
    std::filesystem::copy(written_->sample.volume_path(), path_,
                          std::filesystem::copy_options::recursive);
  }

  Volume open() const { return Volume::open(path_); }
  Volume open_watched(std::size_t most_open = 64) const {
    Volume volume = Volume::open(std::make_unique<WatchedReader>(path_, record_, most_open));
    record_->reads = 0;
    return volume;
  }

  static std::vector<ChunkIndex> all_chunks(const Volume& volume, int level) {
    std::vector<ChunkIndex> indices;
    const auto& chunk = volume.layout().chunk;
    const GridSize size = volume.level(level).size;
    for (std::int32_t z = 0; z * chunk[0] < size.z; ++z) {
      for (std::int32_t y = 0; y * chunk[1] < size.y; ++y) {
        for (std::int32_t x = 0; x * chunk[2] < size.x; ++x) {
          indices.push_back({z, y, x});
        }
      }
    }
    return indices;
  }

  struct Written {
    TemporaryFolder folder;
    SampleFolder sample = sample_with_layers(folder.path() / "s", {60, 24, 12}, 8, 8);
  };
  static inline std::unique_ptr<Written> written_;

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "volume";
  std::filesystem::path shard_ = path_ / "0" / "c" / "0" / "0" / "0" / "0";
  std::shared_ptr<WatchedReader::Record> record_ = std::make_shared<WatchedReader::Record>();
};

TEST_F(ManyChunks, AreWhatTheyAreOneByOneOnEveryLevel) {
  const Volume volume = open();
  ASSERT_GT(volume.levels(), 2);
  std::mt19937 random(1);
  std::size_t not_written = 0;
  for (int level = 0; level < volume.levels(); ++level) {
    std::vector<ChunkIndex> indices = all_chunks(volume, level);
    for (int round = 0; round < 10; ++round) {
      std::shuffle(indices.begin(), indices.end(), random);
      const std::vector<ChunkIndex> wanted(
          indices.begin(),
          indices.begin() + static_cast<std::ptrdiff_t>(1 + random() % indices.size()));
      const ReadChunks read(volume, level, wanted);
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        ASSERT_EQ(read.times[i], 1);
        ASSERT_EQ(read.damage[i], "");
        const auto alone = volume.read_chunk(level, wanted[i]);
        not_written += alone ? 0U : 1U;
        ASSERT_EQ(read.voxels[i], alone ? *alone : ChunkVoxels()) << level;
      }
    }
  }
  EXPECT_GT(not_written, 0U);
}

TEST_F(ManyChunks, OfNoNumberAreNone) {
  EXPECT_TRUE(ReadChunks(open(), 0, {}).times.empty());
}

TEST_F(ManyChunks, ThatLieSideBySideAreReadAtOnce) {
  const Volume volume = open_watched();
  std::vector<ChunkIndex> wanted;
  for (const ChunkIndex& index : all_chunks(volume, 0)) {
    if (index.z < 2) {  // the layers that there are
      wanted.push_back(index);
    }
  }
  ReadChunks(volume, 0, wanted);
  std::uintmax_t stored = 0;
  int shards = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path_ / "0" / "c")) {
    stored += entry.is_regular_file() ? entry.file_size() : 0;
    shards += entry.is_regular_file() ? 1 : 0;
  }
  // The whole of every shard, its index first and its chunks in one go: no byte twice.
  EXPECT_EQ(static_cast<std::uintmax_t>(volume.statistics().bytes_read), stored);
  EXPECT_EQ(record_->reads, 2 * shards);
  EXPECT_EQ(static_cast<std::size_t>(volume.statistics().chunks_read), wanted.size());
}

TEST_F(ManyChunks, ThatDoNotLieSideBySideCostNoByteBetweenThem) {
  const auto bytes_of = [&](const std::vector<ChunkIndex>& wanted) {
    const Volume volume = open();
    ReadChunks(volume, 0, wanted);
    return volume.statistics().bytes_read.load();
  };
  const auto index = static_cast<std::int64_t>(kIndexBytes);
  EXPECT_EQ(bytes_of({{0, 0, 2}, {0, 0, 0}}) - index,
            bytes_of({{0, 0, 0}}) - index + bytes_of({{0, 0, 2}}) - index);
  EXPECT_GT(bytes_of({{0, 0, 0}}), index);
}

TEST_F(ManyChunks, ThatAreExpectedAreReadAheadInTheSameRunsAndNotCounted) {
  const Volume volume = open_watched();
  const std::vector<ChunkIndex> wanted{{0, 0, 2}, {0, 0, 0}, {0, 0, 1}, {2, 0, 0}};
  volume.expect_chunks(0, wanted);
  EXPECT_EQ(record_->reads, 1);  // the shard's index
  EXPECT_EQ(volume.statistics().bytes_read, static_cast<std::int64_t>(kIndexBytes));
  ASSERT_EQ(record_->expected.size(), 1U);
  ReadChunks(volume, 0, wanted);
  EXPECT_EQ(record_->reads, 2);
  EXPECT_EQ(volume.statistics().bytes_read,
            static_cast<std::int64_t>(kIndexBytes + record_->expected.front().second));
}

TEST_F(ManyChunks, ThatAreExpectedInADamagedShardAreLeftToTheReading) {
  truncate_file(shard_, 0.0);
  const Volume volume = open();
  const std::vector<ChunkIndex> wanted{{0, 0, 0}};
  EXPECT_NO_THROW(volume.expect_chunks(0, wanted));
  EXPECT_THAT(ReadChunks(volume, 0, wanted).damage, ElementsAre(StartsWith(shard_.string())));
}

TEST_F(ManyChunks, AroundADamagedOneInARunAllArrive) {
  const std::vector<ChunkIndex> run{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 1, 0}, {0, 1, 1}};
  const ReadChunks whole(open(), 0, run);
  {
    const Volume volume = open();
    ReadChunks(volume, 0, {run[0], run[1]});
    const auto two = static_cast<std::size_t>(volume.statistics().bytes_read) - kIndexBytes;
    flip_byte(shard_, two + 40);  // in the third
  }
  const Volume volume = open_watched();
  const ReadChunks read(volume, 0, run);
  EXPECT_EQ(record_->reads, 2);
  EXPECT_THAT(read.times, ElementsAre(1, 1, 1, 1, 1));
  for (const std::size_t i : {0U, 1U, 3U, 4U}) {
    EXPECT_EQ(read.voxels[i], whole.voxels[i]);
    EXPECT_EQ(read.damage[i], "");
  }
  EXPECT_THAT(read.damage[2],
              AllOf(StartsWith(shard_.string()), HasSubstr("chunk z 0, y 0, x 2 is damaged")));
}

TEST_F(ManyChunks, OfADamagedIndexAreDamagedEachAndTheOthersArrive) {
  flip_byte(shard_, std::filesystem::file_size(shard_) - 10);
  const ReadChunks read(open(), 0, {{0, 0, 0}, {0, 0, 3}, {0, 1, 2}});
  EXPECT_THAT(read.times, ElementsAre(1, 1, 1));
  EXPECT_THAT(read.damage, ElementsAre(HasSubstr("checksum of its index"), "",
                                       HasSubstr("checksum of its index")));
  EXPECT_FALSE(read.voxels[1].empty());
}

TEST_F(ManyChunks, ThrowWhatIsDamagedWhenNobodyTakesIt) {
  flip_byte(shard_, 40);
  const std::vector<ChunkIndex> wanted{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  EXPECT_THAT(message_of<SampleError>([&] {
                open().read_chunks(0, wanted, [](std::size_t, std::span<const std::byte>) {});
              }),
              AllOf(StartsWith(shard_.string()), HasSubstr("chunk z 0, y 0, x 0 is damaged")));
}

TEST_F(ManyChunks, OfAShardThatIsReplacedAfterItsIndexWasReadAreWhollyOldOrNew) {
  const std::vector<ChunkIndex> wanted{{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 3}};
  const ReadChunks before(open(), 0, wanted);
  // Another writer's shard, of layers that compress to other lengths, takes the place of the first
  // once the indices of both were read.
  const SampleFolder sample = sample_with_layers(folder_.path() / "other", {60, 24, 12}, 8, 0);
  for (std::int64_t layer = 1; layer <= 8; ++layer) {
    write_layer_image(sample.layer_path(layer),
                      layer <= 4 ? cv::Mat(24, 60, CV_8UC3, cv::Scalar(1, 2, 3))
                                 : test_image(60, 24, CV_8UC3, static_cast<std::uint64_t>(layer)),
                      {layer, {1, 1, 1}}, {});
  }
  VolumeWriter(sample, open().layout()).append(8, false);
  const auto other = sample.volume_path();
  const ReadChunks after(Volume::open(other), 0, wanted);
  ASSERT_NE(before.voxels, after.voxels);

  // With room for one open file the first shard has been closed when its chunks' turn comes.
  for (const std::size_t most_open : {64U, 1U}) {
    const Volume volume = open_watched(most_open);
    std::once_flag replaced;
    record_->before_read = [&] {
      if (record_->reads >= 2) {
        std::call_once(replaced, [&] {
          std::filesystem::copy_file(other / "0" / "c" / "0" / "0" / "0" / "0",
                                     folder_.path() / "shard");
          std::filesystem::rename(folder_.path() / "shard", shard_);
        });
      }
    };
    const ReadChunks read(volume, 0, wanted);
    EXPECT_THAT(read.times, ElementsAre(1, 1, 1, 1));
    EXPECT_THAT(read.damage, ElementsAre("", "", "", ""));
    EXPECT_EQ(read.voxels, most_open == 1 ? after.voxels : before.voxels);
    std::filesystem::copy_file(written_->sample.volume_path() / "0" / "c" / "0" / "0" / "0" / "0",
                               shard_, std::filesystem::copy_options::overwrite_existing);
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
