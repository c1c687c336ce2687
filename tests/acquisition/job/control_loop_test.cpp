#include "acquisition/job/control_loop.hpp"

#include <algorithm>
#include <chrono>
#include <future>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;

TEST(ControlLoop, TicksUntilItIsDestroyed) {
  std::promise<void> third;
  std::vector<TimePoint> ticks;
  {
    const ControlLoop loop(
        milliseconds(1),
        [&](TimePoint now) {
          ticks.push_back(now);
          if (ticks.size() == 3) third.set_value();
        },
        [](const char* why) { FAIL() << why; });
    third.get_future().wait();
  }
  EXPECT_GE(ticks.size(), 3U);
  EXPECT_TRUE(std::is_sorted(ticks.begin(), ticks.end()));
}

/// Tells, from the loop's own thread, what came after its failure: its end or another tick.
struct Aftermath {
  std::promise<void> promise;
  bool is_known = false;
  void tell() {
    if (!std::exchange(is_known, true)) promise.set_value();
  }
};
struct TellsAtTheThreadsEnd {
  Aftermath& aftermath;
  ~TellsAtTheThreadsEnd() { aftermath.tell(); }
};

TEST(ControlLoop, EndsWithTheFirstTickThatThrowsAndTellsItOnce) {
  Aftermath aftermath;
  int ticks = 0;
  std::vector<std::string> failures;
  std::optional<ControlLoop> loop;
  loop.emplace(
      milliseconds(0),
      [&](TimePoint) {
        thread_local const TellsAtTheThreadsEnd at_the_end{aftermath};
        ++ticks;
        if (ticks == 2) throw std::runtime_error("the desk is gone");
        if (ticks > 2) aftermath.tell();
      },
      [&](const char* why) { failures.emplace_back(why); });
  aftermath.promise.get_future().wait();
  loop.reset();
  EXPECT_EQ(ticks, 2);
  EXPECT_THAT(failures, ElementsAre("the desk is gone"));
}

}  // namespace
}  // namespace biotomy::acquisition
