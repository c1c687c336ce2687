#include "reconstruct/disk/write_behind.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <future>
#include <stdexcept>
#include <system_error>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace biotomy::reconstruct {
namespace {

TEST(WriteBehind, HasStoredEverythingWhenItIsFinished) {
  std::atomic<int> stored{0};
  WriteBehind disk(1000, 2);
  for (int i = 0; i < 100; ++i) {
    disk.add(1, [&] { ++stored; });
  }
  disk.finish();
  EXPECT_EQ(stored, 100);
  disk.add(1, [&] { ++stored; });  // it can go on
  disk.finish();
  EXPECT_EQ(stored, 101);
}

TEST(WriteBehind, HoldsNoMoreBytesThanItMay) {
  std::atomic<int> held{0};
  std::atomic<int> most{0};
  WriteBehind disk(100, 3);
  for (int i = 0; i < 200; ++i) {
    disk.add(30, [&] { held -= 30; });
    most = std::max(most.load(), held += 30);
  }
  disk.finish();
  EXPECT_LE(most, 100);
}

TEST(WriteBehind, LetsATaskThroughThatIsLargerThanItsRoom) {
  bool stored = false;
  WriteBehind disk(10, 1);
  disk.add(1000, [&] { stored = true; });
  disk.finish();
  EXPECT_TRUE(stored);
}

TEST(WriteBehind, ThrowsTheFirstFailureAndBeginsNothingMore) {
  std::promise<void> failed;
  std::atomic<bool> later{false};
  WriteBehind disk(1000, 1);
  disk.add(1, [&] {
    failed.set_value();
    throw std::runtime_error("the disk is full");
  });
  failed.get_future().wait();
  EXPECT_THROW(disk.finish(), std::runtime_error);
  EXPECT_THROW(disk.add(1, [&] { later = true; }), std::runtime_error);
  EXPECT_FALSE(later);
}

TEST(WriteBehind, WaitsForWhatWasBegunWhenItIsDestroyed) {
  std::promise<void> begun;
  std::promise<void> go_on;
  std::atomic<bool> stored{false};
  std::thread release;
  {
    WriteBehind disk(1000, 1);
    disk.add(1, [&] {
      begun.set_value();
      go_on.get_future().wait();
      stored = true;
    });
    begun.get_future().wait();
    release = std::thread([&] { go_on.set_value(); });
  }
  EXPECT_TRUE(stored);
  release.join();
}

// Sanitizers need more address space than that themselves.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// In a process of its own, whose address space has room for the stacks of a few threads only.
TEST(WriteBehindDeathTest, ThrowsWhereNotAllThreadsCanBeStarted) {
  const auto start_too_many = [] {
    const rlimit room{rlim_t{1} << 30, rlim_t{1} << 30};
    ::setrlimit(RLIMIT_AS, &room);
    try {
      const WriteBehind disk(1, 10'000);
    } catch (const std::system_error&) {
      std::_Exit(0);
    }
    std::_Exit(1);
  };
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(start_too_many(), testing::ExitedWithCode(0), "");
}
#endif

}  // namespace
}  // namespace biotomy::reconstruct
