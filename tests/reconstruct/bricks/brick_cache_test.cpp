#include "reconstruct/bricks/brick_cache.hpp"

#include <algorithm>
#include <atomic>
#include <future>
#include <iterator>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

namespace biotomy::reconstruct {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::UnorderedElementsAre;

constexpr std::size_t kBrickBytes = 1000;

/// The brick with the cells that are missing in it: its first byte is the x of its index.
KeptBrick made_for(const BrickFetch& wanted) {
  if (wanted.part.index.y == 9) {
    return nullptr;
  }
  const KeptBrick brick = wanted.kept ? wanted.kept
                                      : std::make_shared<PartialBrick>(std::make_shared<std::byte>(
                                            static_cast<std::byte>(wanted.part.index.x)));
  brick->add(wanted.part.cells, [](CellSet, std::byte*) {});
  return brick;
}

/// What the cache fetches from.
struct Shelf {
  std::vector<std::vector<ChunkIndex>> fetches;
  std::vector<CellSet> cells;  ///< of all fetches' bricks
  bool broken = false;

  std::vector<KeptBrick> fetch(std::span<const BrickFetch> wanted) {
    fetches.emplace_back();
    for (const BrickFetch& each : wanted) {
      fetches.back().push_back(each.part.index);
      cells.push_back(each.part.cells);
    }
    if (broken) {
      throw std::runtime_error("the shelf is broken");
    }
    std::vector<KeptBrick> bricks;
    std::transform(wanted.begin(), wanted.end(), std::back_inserter(bricks), made_for);
    return bricks;
  }

  BrickCache::Fetch function() {
    return [this](int, std::span<const BrickFetch> wanted) { return fetch(wanted); };
  }
};

std::vector<BrickPart> parts(const std::vector<ChunkIndex>& wanted, CellSet cells) {
  std::vector<BrickPart> result;
  for (const ChunkIndex& index : wanted) {
    result.push_back({index, cells});
  }
  return result;
}

std::vector<TexelBrick> get(BrickCache& cache, const std::vector<ChunkIndex>& wanted, int level = 0,
                            CellSet cells = 1) {
  return cache.get(level, parts(wanted, cells));
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
  EXPECT_THAT(cache.missing(0, parts(both, 1)), ElementsAre(ChunkIndex{0, 0, 2}));
  get(cache, both);
  EXPECT_THAT(cache.missing(0, parts(both, 1)), IsEmpty());
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
  BrickCache cache(1000 * kBrickBytes, kBrickBytes, [&](int, std::span<const BrickFetch> wanted) {
    fetched += static_cast<int>(wanted.size());
    std::vector<KeptBrick> bricks;
    std::transform(wanted.begin(), wanted.end(), std::back_inserter(bricks), made_for);
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

TEST(BricksInACache, AreFetchedOnceMoreForCellsThatTheyLack) {
  Shelf shelf;
  BrickCache cache(10 * kBrickBytes, kBrickBytes, shelf.function());
  const auto first = get(cache, {{0, 0, 1}}, 0, 0b0110);
  EXPECT_EQ(get(cache, {{0, 0, 1}}, 0, 0b0010), first);
  EXPECT_THAT(cache.missing(0, parts({{0, 0, 1}}, 0b1000)), ElementsAre(ChunkIndex{0, 0, 1}));
  EXPECT_EQ(get(cache, {{0, 0, 1}}, 0, 0b1000), first) << "added to the same brick";
  EXPECT_EQ(get(cache, {{0, 0, 1}}, 0, 0b1110), first);
  EXPECT_THAT(shelf.cells, ElementsAre(0b0110, 0b1000));
}

// The second asker waits for the first, whose fetch goes on only once it does so.
TEST(BricksInACache, AreFetchedOnceMoreByWhoWaitedForThemWithOtherCells) {
  constexpr ChunkIndex kShared{0, 0, 1};
  constexpr ChunkIndex kOther{0, 0, 2};
  std::promise<void> first_begins;
  std::promise<void> second_waits;
  std::mutex mutex;
  std::vector<std::pair<ChunkIndex, CellSet>> fetched;
  BrickCache cache(10 * kBrickBytes, kBrickBytes, [&](int, std::span<const BrickFetch> wanted) {
    std::vector<KeptBrick> bricks;
    for (const BrickFetch& each : wanted) {
      if (each.part.index == kOther) {
        second_waits.set_value();
      } else if (each.part.cells == 0b01) {
        first_begins.set_value();
        second_waits.get_future().wait();
      }
      const std::scoped_lock lock(mutex);
      fetched.emplace_back(each.part.index, each.part.cells);
      bricks.push_back(made_for(each));
    }
    return bricks;
  });
  std::thread first([&] { cache.get(0, std::vector<BrickPart>{{kShared, 0b01}}); });
  first_begins.get_future().wait();
  const auto bricks = cache.get(0, std::vector<BrickPart>{{kShared, 0b10}, {kOther, 0b01}});
  first.join();
  EXPECT_EQ(*bricks[0], std::byte{1});
  EXPECT_EQ(*bricks[1], std::byte{2});
  EXPECT_THAT(fetched,
              UnorderedElementsAre(Pair(kShared, 0b01), Pair(kOther, 0b01), Pair(kShared, 0b10)));
  EXPECT_THAT(cache.missing(0, parts({kShared}, 0b11)), IsEmpty());
}

TEST(BricksInACache, HaveEachThreadsCells) {
  std::atomic<int> fetched = 0;
  BrickCache cache(1000 * kBrickBytes, kBrickBytes, [&](int, std::span<const BrickFetch> wanted) {
    fetched += static_cast<int>(wanted.size());
    std::vector<KeptBrick> bricks;
    for (const BrickFetch& each : wanted) {
      const KeptBrick brick = each.kept
                                  ? each.kept
                                  : std::make_shared<PartialBrick>(std::shared_ptr<std::byte>(
                                        new std::byte[4](), std::default_delete<std::byte[]>()));
      brick->add(each.part.cells & 0xF, [](CellSet missing, std::byte* texels) {
        for (int cell = 0; cell < 4; ++cell) {
          texels[cell] |= static_cast<std::byte>(missing >> cell & 1U);
        }
      });
      bricks.push_back(brick);
    }
    return bricks;
  });
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, thread] {
      for (int x = 0; x < 200; ++x) {
        const auto bricks = get(cache, {{0, 0, x}}, 0, CellSet{1} << thread);
        wrong += bricks[0].get()[thread] == std::byte{1} ? 0 : 1;
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(fetched, 800) << "of each brick each cell once";
}

}  // namespace
}  // namespace biotomy::reconstruct
