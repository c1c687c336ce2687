#include "acquisition/rig/channel_comparison.hpp"

#include <gmock/gmock.h>

namespace biotomy::acquisition {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::Optional;

struct ChannelComparisonTest : testing::Test {
  ChannelComparison channels;
  bridge::Interlocks controller;
  bridge::SafetyInputs lines{.estop_pressed = false, .door_open = false};
  TimePoint now{};

  ChannelComparisonTest() { controller.estop_pressed = controller.door_open = false; }

  std::optional<std::string> after(milliseconds time) {
    for (milliseconds passed{0}; passed < time; passed += milliseconds(20)) {
      now += milliseconds(20);
      channels.observe(controller, lines, now);
    }
    return channels.take_disagreement();
  }
};

TEST_F(ChannelComparisonTest, IsContentWhenBothSeeTheSame) {
  EXPECT_EQ(after(milliseconds(10'000)), std::nullopt);
  lines.estop_pressed = lines.door_open = true;
  controller.estop_pressed = controller.door_open = true;
  EXPECT_EQ(after(milliseconds(10'000)), std::nullopt);
}

TEST_F(ChannelComparisonTest, GivesEachOfThemAMoment) {
  lines.estop_pressed = true;
  EXPECT_EQ(after(milliseconds(1900)), std::nullopt);
  controller.estop_pressed = true;
  EXPECT_EQ(after(milliseconds(1900)), std::nullopt);
  lines.estop_pressed = false;
  EXPECT_EQ(after(milliseconds(1900)), std::nullopt);
}

TEST_F(ChannelComparisonTest, TellsWhichOfThemIsDead) {
  lines.door_open = true;
  EXPECT_THAT(after(milliseconds(2100)), Optional(HasSubstr("only the line sees the door open")));
  lines.door_open = false;
  controller.estop_pressed = true;
  EXPECT_THAT(after(milliseconds(2100)),
              Optional(HasSubstr("only the controller sees the e-stop pressed")));
}

TEST_F(ChannelComparisonTest, TellsItOnceUntilTheyAgree) {
  lines.door_open = true;
  EXPECT_NE(after(milliseconds(2100)), std::nullopt);
  EXPECT_EQ(after(milliseconds(60'000)), std::nullopt);
  lines.door_open = false;
  EXPECT_EQ(after(milliseconds(100)), std::nullopt);
  lines.door_open = true;
  EXPECT_NE(after(milliseconds(2100)), std::nullopt);
}

TEST_F(ChannelComparisonTest, SaysNothingOfLinesThatCannotBeRead) {
  controller.door_open = true;
  lines.failure = "the chip is gone";
  EXPECT_EQ(after(milliseconds(10'000)), std::nullopt);
}

}  // namespace
}  // namespace biotomy::acquisition
