#include "reconstruct/store/chunk_cache.hpp"

#include <atomic>
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

using tests::TemporaryFolder;

constexpr std::size_t kChunkBytes = 4 * 8 * 8 * 3;

class CachedVolume : public testing::Test {
 protected:
  CachedVolume() {
    VolumeLayout layout;
    layout.chunk = {4, 8, 8};
    layout.shard = {4, 16, 16};
    VolumeWriter(sample_, layout).append(4, true);
  }

  Volume open() const { return Volume::open(sample_.volume_path()); }

  TemporaryFolder folder_;
  SampleFolder sample_ = sample_with_layers(folder_.path() / "s", {32, 32, 8}, 8, 4);
};

TEST_F(CachedVolume, DecodesAChunkOnce) {
  const Volume volume = open();
  ChunkCache cache(volume, 10 * kChunkBytes);
  const auto first = cache.get({0, 1, 1});
  EXPECT_EQ(cache.get({0, 1, 1}), first);
  EXPECT_EQ(*first, *volume.read_chunk(0, {0, 1, 1}));
  EXPECT_EQ(volume.statistics().chunks_read, 2);  // the second by the line above
}

TEST_F(CachedVolume, IsNullWhereTheVolumeHasFillValue) {
  const Volume volume = open();
  ChunkCache cache(volume, kChunkBytes);
  EXPECT_EQ(cache.get({1, 0, 0}), nullptr);
}

TEST_F(CachedVolume, DropsTheLongestUnusedButNotWhatACallerHolds) {
  const Volume volume = open();
  ChunkCache cache(volume, 2 * kChunkBytes);
  const auto held = cache.get({0, 0, 0});
  const ChunkVoxels copy = *held;
  cache.get({0, 0, 1});
  cache.get({0, 0, 2});
  EXPECT_EQ(*held, copy);
  EXPECT_EQ(volume.statistics().chunks_read, 3);
  cache.get({0, 0, 1});
  EXPECT_EQ(volume.statistics().chunks_read, 3);
  cache.get({0, 0, 0});
  EXPECT_EQ(volume.statistics().chunks_read, 4);
}

TEST_F(CachedVolume, ManyThreadsThatAskForTheSameChunksDecodeEachOnce) {
  const Volume volume = open();
  ChunkCache cache(volume, 100 * kChunkBytes);
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      for (std::int32_t i = 0; i < 64; ++i) {
        const ChunkIndex index{0, i / 4 % 4, i % 4};
        const auto chunk = cache.get(index);
        wrong += !chunk || chunk->size() != kChunkBytes ? 1 : 0;
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(volume.statistics().chunks_read, 16);
}

TEST_F(CachedVolume, PassesAnErrorOnAndTriesAgainNextTime) {
  const auto shard = sample_.volume_path() / "0" / "c" / "0" / "0" / "0" / "0";
  const Volume volume = open();
  ChunkCache cache(volume, 10 * kChunkBytes);
  flip_byte(shard, 20);
  EXPECT_THROW(cache.get({0, 0, 0}), SampleError);
  flip_byte(shard, 20);  // good again
  EXPECT_NE(cache.get({0, 0, 0}), nullptr);
}

}  // namespace
}  // namespace biotomy::reconstruct
