#include "firmware_bridge/lines/gpiod_lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_bridge/device_error.hpp"
#include "tests/firmware_bridge/lines/fake_gpio_chips.hpp"
#include "tests/firmware_bridge/thrown_message.hpp"

namespace biotomy::bridge {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using testing::FakeGpioChips;
using ::testing::HasSubstr;
using testing::thrown_message;

constexpr const char* kBoard = "/dev/gpiochip0";
constexpr const char* kExpander = "/dev/gpiochip1";
enum Offset : unsigned int { estop, door };
enum OutputOffset : unsigned int { lamp, trigger };

/// E-stop and door on an expander, active low as they are wired on a rig; the outputs on the board.
class GpiodLinesOnChips : public ::testing::Test {
 protected:
  GpiodLinesOnChips() {
    fake_.chips[kBoard] = {.label = "board", .lines = {{"LAMP"}, {"TRIGGER"}}};
    fake_.chips[kExpander] = {.label = "expander", .lines = {{"ESTOP"}, {"DOOR"}}};
    settings_.estop = {.chip = "expander", .line = "ESTOP", .active_low = true};
    settings_.door = {.chip = "expander", .line = "DOOR", .active_low = true};
    settings_.lamp = {.chip = "board", .line = "LAMP"};
    settings_.trigger = {.chip = "board", .line = "TRIGGER", .active_low = true};
    settings_.debounce = 20ms;
    for (FakeGpioChips::Line& line : fake_.chips[kExpander].lines) line.is_high = true;
  }

  std::unique_ptr<GpiodLines> make() {
    return std::make_unique<GpiodLines>(settings_, fake_.make(), [this] { return now_; });
  }

  /// The next tick's look.
  SafetyInputs look(GpiodLines& lines) {
    now_ += 20ms;
    return lines.read_inputs();
  }

  void pulse(Offset line) {
    fake_.pull(kExpander, line, false);
    fake_.pull(kExpander, line, true);
  }

  bool is_high(OutputOffset line) { return fake_.chips[kBoard].lines[line].is_high; }

  FakeGpioChips fake_;
  GpiodLinesSettings settings_;
  std::chrono::steady_clock::time_point now_{1h};
};

TEST(GpiodLines, NameTheChipThatIsNotThere) {
  GpiodLinesSettings settings;
  settings.estop = {.chip = "no-such-chip", .line = "ESTOP"};
  try {
    const GpiodLines lines(settings);
    FAIL() << "nothing was thrown";
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.kind(), DeviceError::Kind::configuration);
    EXPECT_THAT(error.what(), HasSubstr("lines.estop: line ESTOP of GPIO chip no-such-chip"));
  }
}

TEST_F(GpiodLinesOnChips, ReportTheLevelsWithThePolarityApplied) {
  const auto lines = make();
  SafetyInputs inputs = look(*lines);
  EXPECT_FALSE(inputs.estop_pressed);
  EXPECT_FALSE(inputs.door_open);
  EXPECT_EQ(inputs.failure, "");

  fake_.pull(kExpander, door, false);
  inputs = look(*lines);
  EXPECT_FALSE(inputs.estop_pressed);
  EXPECT_TRUE(inputs.door_open);
}

TEST_F(GpiodLinesOnChips, ReportAPulseBetweenTwoLooksOnce) {
  const auto lines = make();
  ASSERT_FALSE(look(*lines).estop_pressed);
  pulse(estop);
  const SafetyInputs inputs = look(*lines);
  EXPECT_TRUE(inputs.estop_pressed);
  EXPECT_FALSE(inputs.door_open);
  EXPECT_FALSE(look(*lines).estop_pressed);
}

TEST_F(GpiodLinesOnChips, ReportASafeInputOnlyAfterTheDebouncePeriod) {
  settings_.debounce = 50ms;
  const auto lines = make();
  pulse(door);
  EXPECT_TRUE(look(*lines).door_open);
  EXPECT_TRUE(look(*lines).door_open);
  EXPECT_TRUE(look(*lines).door_open);
  EXPECT_FALSE(look(*lines).door_open);
}

TEST_F(GpiodLinesOnChips, ReadTheLevelAloneWithoutEdges) {
  settings_.estop.edges = false;
  const auto lines = make();
  pulse(estop);
  EXPECT_FALSE(look(*lines).estop_pressed);
  fake_.pull(kExpander, estop, false);
  EXPECT_TRUE(look(*lines).estop_pressed);
}

TEST_F(GpiodLinesOnChips, AreUnsafeWithTheReasonWhenTheChipIsUnplugged) {
  const auto lines = make();
  ASSERT_FALSE(look(*lines).estop_pressed);
  fake_.unplug(kExpander);
  const SafetyInputs inputs = look(*lines);
  EXPECT_TRUE(inputs.estop_pressed);
  EXPECT_TRUE(inputs.door_open);
  EXPECT_THAT(inputs.failure,
              AllOf(HasSubstr("lines.estop: the line failed"), HasSubstr("lines.door: ")));
  now_ += 1s;
  EXPECT_THAT(look(*lines).failure, HasSubstr("there is no chip of that path, name or label"));
}

TEST_F(GpiodLinesOnChips, AreSafeAgainWhenTheChipIsBackAndTheDebouncePeriodOver) {
  const auto lines = make();
  fake_.unplug(kExpander);
  ASSERT_TRUE(look(*lines).estop_pressed);
  fake_.plug_in(kExpander);
  now_ += 1s;
  lines->read_inputs();  // requests
  EXPECT_FALSE(look(*lines).estop_pressed);
  EXPECT_FALSE(look(*lines).door_open);
  EXPECT_EQ(look(*lines).failure, "");
}

// What the lines did meanwhile is unknown.
TEST_F(GpiodLinesOnChips, AreUnsafeForTheDebouncePeriodAfterTheLastFailure) {
  settings_.debounce = 50ms;
  const auto lines = make();
  fake_.unplug(kExpander);
  ASSERT_NE(look(*lines).failure, "");
  fake_.plug_in(kExpander);
  SafetyInputs inputs = look(*lines);
  for (int tick = 0; tick < 100 && !inputs.failure.empty(); ++tick) inputs = look(*lines);
  ASSERT_EQ(inputs.failure, "") << "the lines are back";
  for (int tick = 1; tick <= 2; ++tick) {
    EXPECT_TRUE(inputs.estop_pressed) << tick;
    EXPECT_TRUE(inputs.door_open) << tick;
    inputs = look(*lines);
  }
  EXPECT_FALSE(inputs.estop_pressed);
  EXPECT_FALSE(inputs.door_open);
}

TEST_F(GpiodLinesOnChips, FindAChipThatCameBackUnderAnotherNumber) {
  const auto lines = make();
  fake_.unplug(kExpander);
  ASSERT_TRUE(look(*lines).estop_pressed);
  auto& other = fake_.chips["/dev/gpiochip5"] = fake_.chips[kExpander];
  other.is_there = true;
  for (FakeGpioChips::Line& line : other.lines) line.consumer.clear();
  now_ += 1s;
  lines->read_inputs();
  EXPECT_FALSE(look(*lines).estop_pressed);
}

TEST_F(GpiodLinesOnChips, AskForALostLineOnceASecond) {
  const auto lines = make();
  fake_.chips[kExpander].io_error = EIO;
  fake_.chips[kExpander].lines[door].request_error = EIO;
  now_ += 1s;
  look(*lines);  // loses both
  const int before = fake_.requests;
  for (int tick = 0; tick < 500; ++tick) look(*lines);  // ten seconds
  EXPECT_LE(fake_.requests - before, 20);
  EXPECT_GE(fake_.requests - before, 18);
}

TEST_F(GpiodLinesOnChips, ReportOneInputWhenTheOtherCannotBeRead) {
  settings_.door.chip = "board";
  fake_.chips[kBoard].lines.push_back({.name = "DOOR", .is_high = true});
  const auto lines = make();
  fake_.unplug(kExpander);
  const SafetyInputs inputs = look(*lines);
  EXPECT_TRUE(inputs.estop_pressed);
  EXPECT_FALSE(inputs.door_open);
  EXPECT_THAT(inputs.failure, HasSubstr("lines.estop"));
}

TEST_F(GpiodLinesOnChips, BeginWithTheOutputsOff) {
  for (FakeGpioChips::Line& line : fake_.chips[kBoard].lines) line.is_high = !line.is_high;
  const auto lines = make();
  EXPECT_FALSE(is_high(lamp));
  EXPECT_TRUE(is_high(trigger));  // active low
}

TEST_F(GpiodLinesOnChips, SwitchOutputsAndSwitchThemOffAtTheEnd) {
  auto lines = make();
  lines->set(OutputRole::lamp, true);
  lines->set(OutputRole::trigger, true);
  EXPECT_TRUE(is_high(lamp));
  EXPECT_FALSE(is_high(trigger));
  lines.reset();
  EXPECT_FALSE(is_high(lamp));
  EXPECT_TRUE(is_high(trigger));
}

TEST_F(GpiodLinesOnChips, SayThatAnOutputIsNotConfigured) {
  const auto lines = make();
  EXPECT_THAT(thrown_message<DeviceError>([&] { lines->set(OutputRole::tower_light, true); }),
              HasSubstr("no line is set for tower_light"));
}

TEST_F(GpiodLinesOnChips, BringALostOutputBackOff) {
  const auto lines = make();
  lines->set(OutputRole::lamp, true);
  fake_.chips[kBoard].io_error = EIO;
  EXPECT_THAT(thrown_message<DeviceError>([&] { lines->set(OutputRole::lamp, false); }),
              HasSubstr("lines.lamp: the line failed"));
  ASSERT_TRUE(is_high(lamp));
  fake_.chips[kBoard].io_error = 0;
  now_ += 1s;
  lines->read_inputs();
  EXPECT_FALSE(is_high(lamp));
  lines->set(OutputRole::lamp, true);
  EXPECT_TRUE(is_high(lamp));
}

TEST_F(GpiodLinesOnChips, EndQuietlyWithoutTheirChips) {
  auto lines = make();
  lines->set(OutputRole::lamp, true);
  fake_.unplug(kBoard);
  fake_.unplug(kExpander);
  look(*lines);
  lines.reset();
  EXPECT_TRUE(is_high(lamp));  // nobody could reach it
}

}  // namespace
}  // namespace biotomy::bridge
