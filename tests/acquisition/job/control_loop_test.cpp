#include "acquisition/job/control_loop.hpp"

#include <algorithm>
#include <chrono>
#include <future>
#include <optional>
#include <stdexcept>
#include <string>
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

TEST(ControlLoop, EndsWithTheFirstTickThatThrowsAndTellsItOnce) {
  std::promise<void> told;
  int ticks = 0;
  std::vector<std::string> failures;
  std::optional<ControlLoop> loop;
  loop.emplace(
      milliseconds(0),
      [&](TimePoint) {
        if (++ticks == 2) throw std::runtime_error("the desk is gone");
      },
      [&](const char* why) {
        failures.emplace_back(why);
        if (failures.size() == 1) told.set_value();
      });
  told.get_future().wait();
  loop.reset();
  EXPECT_EQ(ticks, 2);
  EXPECT_THAT(failures, ElementsAre("the desk is gone"));
}

}  // namespace
}  // namespace biotomy::acquisition
