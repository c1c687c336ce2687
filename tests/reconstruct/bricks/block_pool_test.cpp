#include "reconstruct/bricks/block_pool.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

using Block = std::shared_ptr<std::byte>;

std::vector<Block> blocks_of(BlockPool& pool, std::size_t count) {
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < count; ++i) {
    blocks.push_back(pool.allocate());
  }
  return blocks;
}

TEST(BlockPool, BlocksAreAlignedAndDoNotOverlap) {
  // Blocks by the thousand in a slab, a few, one that takes all of it, and some that need more.
  for (const std::size_t bytes : {1UL, 1000UL, 133'120UL, (2UL << 20) - 64, 3UL << 20}) {
    constexpr std::size_t kSlack = 64;
    BlockPool pool(bytes, kSlack);
    EXPECT_EQ(pool.block_bytes(), bytes);
    const std::vector<Block> blocks = blocks_of(pool, 40);
    std::vector<std::uintptr_t> places;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      places.push_back(reinterpret_cast<std::uintptr_t>(blocks[i].get()));
      EXPECT_EQ(places.back() % 64, 0U);
      std::memset(blocks[i].get(), static_cast<int>(i), bytes + kSlack);
    }
    std::sort(places.begin(), places.end());
    for (std::size_t i = 1; i < places.size(); ++i) {
      EXPECT_GE(places[i] - places[i - 1], bytes + kSlack);
    }
  }
}

TEST(BlockPool, UsesFreedBlocksAgain) {
  BlockPool pool(100'000, 0);
  std::set<std::byte*> seen;
  for (int round = 0; round < 5; ++round) {
    for (const Block& block : blocks_of(pool, 50)) {
      seen.insert(block.get());
    }
  }
  EXPECT_EQ(seen.size(), 50U);
}

TEST(BlockPool, BlocksOutliveTheirPool) {
  Block block;
  {
    BlockPool pool(1000, 64);
    block = pool.allocate();
  }
  std::memset(block.get(), 7, 1000 + 64);
  EXPECT_EQ(block.get()[999], std::byte{7});
}

TEST(BlockPool, GivesEachOfManyThreadsBlocksOfItsOwn) {
  BlockPool pool(50'000, 0);
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, thread] {
      for (int round = 0; round < 200; ++round) {
        const std::vector<Block> blocks = blocks_of(pool, 5);
        for (const Block& block : blocks) {
          std::memset(block.get(), thread, 100);
        }
        for (const Block& block : blocks) {
          wrong += std::count(block.get(), block.get() + 100, static_cast<std::byte>(thread)) == 100
                       ? 0
                       : 1;
        }
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace biotomy::reconstruct
