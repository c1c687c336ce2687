#include "firmware_bridge/lines/input_debounce.hpp"

#include <gtest/gtest.h>

namespace biotomy::bridge {
namespace {

using namespace std::chrono_literals;

constexpr bool kEdges = true;
constexpr bool kNoEdges = false;
constexpr bool kActive = true;
constexpr bool kInactive = false;

constexpr InputDebounce::TimePoint at(std::chrono::milliseconds time) {
  return InputDebounce::TimePoint(1h + time);
}

TEST(InputDebounce, BelievesTheFirstLook) {
  InputDebounce calm(20ms);
  EXPECT_FALSE(calm.look(kNoEdges, kInactive, at(0ms)));
  InputDebounce pressed(20ms);
  EXPECT_TRUE(pressed.look(kNoEdges, kActive, at(0ms)));
}

TEST(InputDebounce, TakesDangerAtOnce) {
  InputDebounce input(20ms);
  ASSERT_FALSE(input.look(kNoEdges, kInactive, at(0ms)));
  EXPECT_TRUE(input.look(kEdges, kActive, at(1ms)));
}

TEST(InputDebounce, SeesAPulseBetweenTwoLooks) {
  InputDebounce input(0ms);
  ASSERT_FALSE(input.look(kNoEdges, kInactive, at(0ms)));
  EXPECT_TRUE(input.look(kEdges, kInactive, at(20ms)));
  EXPECT_FALSE(input.look(kNoEdges, kInactive, at(40ms)));
}

TEST(InputDebounce, TakesALevelForDangerOfWhichItSawNoEdge) {
  InputDebounce input(20ms);
  EXPECT_TRUE(input.look(kNoEdges, kActive, at(0ms)));
  EXPECT_TRUE(input.look(kNoEdges, kInactive, at(19ms)));
  EXPECT_FALSE(input.look(kNoEdges, kInactive, at(20ms)));
}

TEST(InputDebounce, BelievesSafetyOnlyWhenItHasLastedForThePeriod) {
  InputDebounce input(20ms);
  EXPECT_TRUE(input.look(kEdges, kInactive, at(0ms)));
  EXPECT_TRUE(input.look(kNoEdges, kInactive, at(19ms)));
  EXPECT_FALSE(input.look(kNoEdges, kInactive, at(20ms)));
}

TEST(InputDebounce, BeginsThePeriodAnewAtEachEdge) {
  InputDebounce input(20ms);
  for (auto time = 0ms; time < 1s; time += 15ms) {
    EXPECT_TRUE(input.look(kEdges, kInactive, at(time))) << time.count();
  }
  EXPECT_TRUE(input.look(kNoEdges, kInactive, at(1009ms)));
  EXPECT_FALSE(input.look(kNoEdges, kInactive, at(1010ms)));
}

TEST(InputDebounce, CountsALookThatFailedAsAnEdge) {
  InputDebounce input(20ms);
  ASSERT_FALSE(input.look(kNoEdges, kInactive, at(0ms)));
  input.doubt(at(20ms));
  EXPECT_TRUE(input.look(kNoEdges, kInactive, at(39ms)));
  EXPECT_FALSE(input.look(kNoEdges, kInactive, at(40ms)));
}

}  // namespace
}  // namespace biotomy::bridge
