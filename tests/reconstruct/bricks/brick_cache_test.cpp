#include "reconstruct/bricks/brick_cache.hpp"

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

namespace biotomy::reconstruct {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::size_t kBrickBytes = 1000;

/// What the cache fetches from: bricks that are told apart by their first byte, the x of the index.
struct Shelf {
  std::vector<std::vector<ChunkIndex>> fetches;
  bool broken = false;

  std::vector<TexelBrick> fetch(std::span<const ChunkIndex> wanted) {
    fetches.emplace_back(wanted.begin(), wanted.end());
    if (broken) {
      throw std::runtime_error("the shelf is broken");
    }
    std::vector<TexelBrick> bricks;
    for (const ChunkIndex& index : wanted) {
      bricks.push_back(index.y == 9 ? nullptr
                                    : std::make_shared<std::byte>(static_cast<std::byte>(index.x)));
    }
    return bricks;
  }

  BrickCache::Fetch function() {
    return [this](int, std::span<const ChunkIndex> wanted) { return fetch(wanted); };
  }
};

std::vector<TexelBrick> get(BrickCache& cache, const std::vector<ChunkIndex>& wanted,
                            int level = 0) {
  return cache.get(level, wanted);
}

TEST(BricksInACache, AreFetchedTogetherAndOnce) {
  Shelf shelf;
  BrickCache cache(10 * kBrickBytes, kBrickBytes, shelf.function());
  const auto first = get(cache, {{0, 0, 1}, {0, 0, 2}});
  const auto second = get(cache, {{0, 0, 2}, {0, 0, 3}, {0, 0, 1}});
  EXPECT_EQ(second[0], first[1]);
  EXPECT_EQ(second[2], first[0]);
  EXPECT_EQ(*second[1], std::byte{3});
  EXPECT_THAT(shelf.fetches, ElementsAre(ElementsAre(ChunkIndex{0, 0, 1}, ChunkIndex{0, 0, 2}),
                                         ElementsAre(ChunkIndex{0, 0, 3})));
}

TEST(BricksInACache, OfTwoLevelsAreTwo) {
  Shelf shelf;
  BrickCache cache(10 * kBrickBytes, kBrickBytes, shelf.function());
  EXPECT_NE(get(cache, {{0, 0, 1}}, 0), get(cache, {{0, 0, 1}}, 1));
}

TEST(BricksInACache, ThatAreFillValueAreRemembered) {
  Shelf shelf;
  BrickCache cache(kBrickBytes, kBrickBytes, shelf.function());
  EXPECT_EQ(get(cache, {{0, 9, 0}})[0], nullptr);
  EXPECT_EQ(get(cache, {{0, 9, 0}})[0], nullptr);
  EXPECT_EQ(shelf.fetches.size(), 1U);
}

TEST(BricksInACache, GoWhenTheyAreTheLongestUnusedButNotFromWhoHoldsThem) {
  Shelf shelf;
  BrickCache cache(2 * kBrickBytes, kBrickBytes, shelf.function());
  const auto held = get(cache, {{0, 0, 1}});
  get(cache, {{0, 0, 2}});
  get(cache, {{0, 0, 3}});
  EXPECT_EQ(*held[0], std::byte{1});
  get(cache, {{0, 0, 2}, {0, 0, 3}});
  EXPECT_EQ(shelf.fetches.size(), 3U);
  get(cache, {{0, 0, 1}});
  EXPECT_EQ(shelf.fetches.size(), 4U);
}

TEST(BricksInACache, AreMissingUntilTheyWereFetched) {
  Shelf shelf;
  BrickCache cache(10 * kBrickBytes, kBrickBytes, shelf.function());
  get(cache, {{0, 0, 1}});
  const std::vector<ChunkIndex> both{{0, 0, 1}, {0, 0, 2}};
  EXPECT_THAT(cache.missing(0, both), ElementsAre(ChunkIndex{0, 0, 2}));
  get(cache, both);
  EXPECT_THAT(cache.missing(0, both), IsEmpty());
}

TEST(BricksInACache, AreAskedForAgainAfterAFailure) {
  Shelf shelf;
  BrickCache cache(10 * kBrickBytes, kBrickBytes, shelf.function());
  shelf.broken = true;
  EXPECT_THROW(get(cache, {{0, 0, 1}}), std::runtime_error);
  shelf.broken = false;
  EXPECT_EQ(*get(cache, {{0, 0, 1}})[0], std::byte{1});
}

TEST(BricksInACache, AreFetchedOnceForManyThreads) {
  std::atomic<int> fetched = 0;
  BrickCache cache(1000 * kBrickBytes, kBrickBytes, [&](int, std::span<const ChunkIndex> wanted) {
    fetched += static_cast<int>(wanted.size());
    std::vector<TexelBrick> bricks;
    for (const ChunkIndex& index : wanted) {
      bricks.push_back(std::make_shared<std::byte>(static_cast<std::byte>(index.x)));
    }
    return bricks;
  });
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      for (int x = 0; x < 100; ++x) {
        const auto bricks = get(cache, {{0, 0, x}, {0, 0, (x + 50) % 100}});
        wrong += *bricks[0] != static_cast<std::byte>(x) ? 1 : 0;
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(fetched, 100);
}

}  // namespace
}  // namespace biotomy::reconstruct
