// Two who ask one cache from one arena, as the page's pictures do.
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include "reconstruct/bricks/brick_cache.hpp"
#include "reconstruct/whole_loop.hpp"

namespace biotomy::reconstruct {
namespace {

using namespace std::chrono_literals;

constexpr int kThreads = 3;
constexpr std::size_t kBrickBytes = 1000;

/// Whether it came true in time.
bool wait_until(const std::atomic<bool>& condition, std::chrono::milliseconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!condition) {
    if (std::chrono::steady_clock::now() > end) {
      return false;
    }
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

/// One asker fetches a brick in two parts, one of which another thread has taken and does not
/// finish yet, so that it waits. The other asker leaves the wish for the same brick where a waiting
/// thread may take it up, which must not be the one that fetches it: it would wait for itself, for
/// ever.
TEST(BricksInACache, AreNotAwaitedByTheThreadThatFetchesThem) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, kThreads);
  std::atomic<bool> fetching{false};
  std::atomic<bool> other_part_begun{false};
  std::atomic<bool> taken_up{false};
  BrickCache cache(10 * kBrickBytes, kBrickBytes, [&](int, std::span<const BrickFetch> wanted) {
    const auto asker = std::this_thread::get_id();
    whole_loop(2, [&](std::size_t) {
      if (std::this_thread::get_id() == asker) {
        fetching = true;
        EXPECT_TRUE(wait_until(other_part_begun, 10s));
      } else {
        other_part_begun = true;
        wait_until(taken_up, 300ms);
      }
    });
    return std::vector<KeptBrick>(wanted.size());
  });
  const std::vector<BrickPart> wish{{ChunkIndex{0, 0, 0}, 1}};
  tbb::task_arena arena(kThreads);
  arena.execute([&] {
    tbb::parallel_invoke([&] { cache.get(0, wish); },
                         [&] {
                           EXPECT_TRUE(wait_until(fetching, 10s));
                           tbb::task_group others;
                           others.run([&] {
                             taken_up = true;
                             cache.get(0, wish);
                           });
                           wait_until(taken_up, 300ms);
                           others.wait();
                         });
  });
  EXPECT_TRUE(taken_up);
}

}  // namespace
}  // namespace biotomy::reconstruct
