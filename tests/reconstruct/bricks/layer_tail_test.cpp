#include "reconstruct/bricks/layer_tail.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <map>
#include <mutex>
#include <ostream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::HasSubstr;

VolumeLayout small_layout() {
  VolumeLayout layout;
  layout.chunk = {2, 8, 16};
  layout.shard = {4, 16, 32};  // bands of four layers
  return layout;
}

std::vector<ChunkIndex> chunks_of(const Volume& volume, int level) {
  const GridSize& size = volume.level(level).size;
  const auto& chunk = volume.layout().chunk;
  std::vector<ChunkIndex> indices;
  for (std::int32_t z = 0; z * chunk[0] < size.z; ++z) {
    for (std::int32_t y = 0; y * chunk[1] < size.y; ++y) {
      for (std::int32_t x = 0; x * chunk[2] < size.x; ++x) {
        indices.push_back({z, y, x});
      }
    }
  }
  return indices;
}

using Chunks = std::map<ChunkIndex, ChunkVoxels>;

/// All chunks of a level that are not fill value, with the tail laid over them.
Chunks chunks_with(const LayerTail& tail, const Volume& volume, int level) {
  Chunks chunks;
  std::mutex mutex;
  std::vector<ChunkIndex> overlaid;
  const auto keep = [&](const ChunkIndex& index, std::span<const std::byte> voxels) {
    const std::lock_guard lock(mutex);
    if (std::any_of(voxels.begin(), voxels.end(), [](std::byte b) { return b != std::byte{}; })) {
      chunks[index] = {voxels.begin(), voxels.end()};
    }
  };
  for (const ChunkIndex& index : chunks_of(volume, level)) {
    if (tail.touches(level, index)) {
      overlaid.push_back(index);
    } else if (const auto voxels = volume.read_chunk(level, index)) {
      keep(index, *voxels);
    }
  }
  tail.read_chunks(level, overlaid, [&](std::size_t which, std::span<const std::byte> voxels) {
    keep(overlaid[which], voxels);
  });
  return chunks;
}

Chunks chunks_of_level(const Volume& volume, int level) {
  Chunks chunks;
  for (const ChunkIndex& index : chunks_of(volume, level)) {
    if (const auto voxels = volume.read_chunk(level, index)) {
      chunks[index] = *voxels;
    }
  }
  return chunks;
}

/// A sample in the middle of its job, and what is expected of it.
struct Moment {
  std::string name;
  GridSize size;
  Vector3 spacing;
  int bits = 8;
  VolumeLayout layout;
  std::int64_t layers_in_volume = 0;
  std::int64_t layers_on_disk = 0;

  friend std::ostream& operator<<(std::ostream& out, const Moment& moment) {
    return out << moment.name;
  }
};

class EveryLevelWithATail : public testing::TestWithParam<Moment> {};

TEST_P(EveryLevelWithATail, IsThatOfTheVolumeThatHoldsTheSameLayers) {
  const Moment& moment = GetParam();
  const tests::TemporaryFolder folder;
  const SampleFolder sample = sample_with_layers(folder / "live", moment.size, moment.bits,
                                                 moment.layers_in_volume, moment.spacing);
  VolumeWriter(sample, moment.layout).append(moment.layers_in_volume, true);
  add_layers(sample, moment.layers_in_volume + 1, moment.layers_on_disk);
  const SampleFolder finished = sample_with_layers(folder / "finished", moment.size, moment.bits,
                                                   moment.layers_on_disk, moment.spacing);
  VolumeWriter(finished, moment.layout).append(moment.layers_on_disk, true);

  const Volume volume = Volume::open(sample.volume_path());
  const Volume expected = Volume::open(finished.volume_path());
  ASSERT_EQ(volume.layers_present(), moment.layers_in_volume);
  const LayerTail tail(sample, volume);
  EXPECT_EQ(tail.layers_present(), moment.layers_on_disk);
  ASSERT_GT(volume.levels(), 2);
  for (int level = 0; level < volume.levels(); ++level) {
    EXPECT_TRUE(chunks_with(tail, volume, level) == chunks_of_level(expected, level)) << level;
  }
}

VolumeLayout layout_of(const std::array<int, 3>& chunk, const std::array<int, 3>& shard) {
  VolumeLayout layout;
  layout.chunk = chunk;
  layout.shard = shard;
  return layout;
}

constexpr GridSize kSmall{70, 45, 29};
constexpr Vector3 kFlat{10, 11, 50};  // micrometres: voxels deeper than they are wide
constexpr Vector3 kDeep{40, 50, 10};
constexpr Vector3 kCubic{10, 10, 10};

INSTANTIATE_TEST_SUITE_P(
    , EveryLevelWithATail,
    testing::Values(
        Moment{"NoLayer", kSmall, kFlat, 8, small_layout(), 8, 8},
        Moment{"OneLayer", kSmall, kFlat, 8, small_layout(), 8, 9},
        Moment{"AllOfABandButOne", kSmall, kFlat, 8, small_layout(), 8, 11},
        Moment{"AllOfABandButOneOf16Bits", kSmall, kCubic, 16, small_layout(), 8, 11},
        Moment{"SeveralBands", kSmall, kCubic, 8, small_layout(), 12, 27},
        Moment{"ToTheDeepEnd", kSmall, kCubic, 8, small_layout(), 20, 29},
        Moment{"OneLayerOfDeepVoxels", kSmall, kDeep, 16, small_layout(), 20, 21},
        Moment{"FlatlyHalvedFirst", kSmall, kDeep, 8, small_layout(), 12, 15},
        Moment{"FromAnIncompleteBandOn", kSmall, kCubic, 8, small_layout(), 10, 13},
        Moment{"NothingButTheTail", kSmall, kCubic, 8, small_layout(), 0, 7},
        Moment{"ManyTiles", {700, 300, 20}, kFlat, 8, layout_of({4, 32, 32}, {4, 64, 64}), 8, 11},
        Moment{"ChunksThatTilesDoNotHold",
               {330, 290, 9},
               kCubic,
               16,
               layout_of({2, 24, 40}, {4, 48, 80}),
               4,
               7}),
    [](const auto& moment) { return moment.param.name; });

class ALayerTail : public testing::Test {
 protected:
  /// A sample with 8 layers in the volume and files 9 to 11.
  ALayerTail() {
    VolumeWriter(sample_, small_layout()).append(8, false);
    add_layers(sample_, 9, 11);
  }

  std::string failure_of(const LayerTail& tail, const Volume& volume) const {
    return message_of<SampleError>([&] { chunks_with(tail, volume, 0); });
  }

  tests::TemporaryFolder folder_;
  SampleFolder sample_ = sample_with_layers(folder_ / "s", kSmall, 8, 8, kCubic);
};

TEST_F(ALayerTail, EndsAtTheFirstGap) {
  std::filesystem::remove(sample_.layer_path(10));
  const Volume volume = Volume::open(sample_.volume_path());
  EXPECT_EQ(LayerTail(sample_, volume).layers_present(), 9);
}

TEST_F(ALayerTail, TouchesWhatItChangesAlone) {
  const Volume volume = Volume::open(sample_.volume_path());
  const LayerTail tail(sample_, volume);
  EXPECT_FALSE(tail.touches(0, {3, 0, 0}));
  EXPECT_TRUE(tail.touches(0, {4, 0, 0}));
  EXPECT_FALSE(tail.touches(1, {1, 0, 0}));
  EXPECT_TRUE(tail.touches(1, {2, 0, 0}));
  for (int layer = 9; layer <= 11; ++layer) {
    std::filesystem::remove(sample_.layer_path(layer));
  }
  EXPECT_FALSE(LayerTail(sample_, volume).touches(0, {4, 0, 0}));
}

TEST_F(ALayerTail, StaysAsItWasWhileAWriterClosesBands) {
  const SampleFolder finished = sample_with_layers(folder_ / "f", kSmall, 8, 11, kCubic);
  VolumeWriter(finished, small_layout()).append(11, true);
  const Volume expected = Volume::open(finished.volume_path());
  std::vector<Chunks> levels;
  for (int level = 0; level < expected.levels(); ++level) {
    levels.push_back(chunks_of_level(expected, level));
  }

  const Volume volume = Volume::open(sample_.volume_path());
  const LayerTail tail(sample_, volume);
  const auto is_as_it_was = [&] {
    for (int level = 0; level < volume.levels(); ++level) {
      if (chunks_with(tail, volume, level) != levels[static_cast<std::size_t>(level)]) {
        return false;
      }
    }
    return true;
  };
  EXPECT_TRUE(is_as_it_was());
  std::atomic<bool> done = false;
  std::jthread writer([&] {
    VolumeWriter volume_writer(sample_, small_layout());
    for (std::int64_t layer = 12; layer <= kSmall.z; ++layer) {
      add_layers(sample_, layer, layer);
      volume_writer.append(layer, false);
    }
    done = true;
  });
  while (!done) {
    EXPECT_TRUE(is_as_it_was());
  }
  EXPECT_TRUE(is_as_it_was());
}

TEST_F(ALayerTail, NamesALayerThatHasVanished) {
  const Volume volume = Volume::open(sample_.volume_path());
  const LayerTail tail(sample_, volume);
  std::filesystem::remove(sample_.layer_path(10));
  EXPECT_THAT(failure_of(tail, volume), HasSubstr("000010.tif"));
}

TEST_F(ALayerTail, NamesALayerThatIsDamagedOrOfAnotherSize) {
  const Volume volume = Volume::open(sample_.volume_path());
  const LayerTail tail(sample_, volume);
  truncate_file(sample_.layer_path(11), 0.4);
  EXPECT_THAT(failure_of(tail, volume), HasSubstr("000011.tif"));
  write_layer_image(sample_.layer_path(11), test_image(70, 46), {11, kCubic}, {});
  EXPECT_THAT(failure_of(tail, volume), AllOf(HasSubstr("000011.tif"), HasSubstr("70 × 46")));
}

TEST_F(ALayerTail, TellsWhichChunksADamagedLayerTakesAlong) {
  const Volume volume = Volume::open(sample_.volume_path());
  const LayerTail tail(sample_, volume);
  truncate_file(sample_.layer_path(11), 0.4);
  const std::vector<ChunkIndex> wanted{{4, 0, 0}, {5, 0, 0}, {6, 0, 0}};
  std::vector<std::size_t> given;
  std::vector<std::size_t> damaged;
  std::mutex mutex;
  tail.read_chunks(
      0, wanted,
      [&](std::size_t which, std::span<const std::byte> /*voxels*/) {
        const std::lock_guard lock(mutex);
        given.push_back(which);
      },
      [&](std::size_t which, const SampleError& error) {
        const std::lock_guard lock(mutex);
        damaged.push_back(which);
        EXPECT_THAT(error.what(), HasSubstr("000011.tif"));
      });
  EXPECT_THAT(given, testing::UnorderedElementsAre(0, 2));
  EXPECT_THAT(damaged, testing::ElementsAre(1));
}

TEST_F(ALayerTail, IsRefusedOverTheVolumeOfAnotherSample) {
  const SampleFolder other = sample_with_layers(folder_ / "other", {70, 46, 29}, 8, 4, kCubic);
  VolumeWriter(other, small_layout()).append(4, false);
  const Volume volume = Volume::open(other.volume_path());
  EXPECT_THAT(message_of<SampleError>([&] { LayerTail(sample_, volume); }),
              HasSubstr("biotomy rebuild"));
}

}  // namespace
}  // namespace biotomy::reconstruct
