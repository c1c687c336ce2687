#include "acquisition/service/watched_worker.hpp"

#include <gtest/gtest.h>

#include "tests/acquisition/fake_rig.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

TEST(WatchedWorker, TellsSinceWhenItIsAtItsTask) {
  TimePoint now{std::chrono::hours(1)};
  InlineWorker thread;
  WatchedWorker worker(thread, [&] { return now; });
  EXPECT_FALSE(worker.busy_since());
  std::optional<TimePoint> seen;
  worker.post([&] {
    const TimePoint began = now;
    now += std::chrono::seconds(5);
    seen = worker.busy_since();
    EXPECT_EQ(seen, began);
  });
  EXPECT_TRUE(seen);
  EXPECT_FALSE(worker.busy_since());
}

}  // namespace
}  // namespace biotomy::tests
