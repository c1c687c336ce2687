#include "firmware_bridge/lines/gpio_line_request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_bridge/device_error.hpp"
#include "tests/firmware_bridge/lines/fake_gpio_chips.hpp"
#include "tests/firmware_bridge/thrown_message.hpp"

namespace biotomy::bridge {
namespace {

using ::testing::AllOf;
using testing::FakeGpioChips;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using testing::thrown_message;

class GpioLineRequestOnChips : public ::testing::Test {
 protected:
  GpioLineRequestOnChips() {
    fake_.chips["/dev/gpiochip0"] = {.label = "board", .lines = {{"SDA"}, {"SCL"}, {""}}};
    fake_.chips["/dev/gpiochip1"] = {.label = "rig", .lines = {{"ESTOP"}, {"DOOR"}, {"0"}}};
  }

  /// Which line of which chip is held after `settings` were asked for, as "/dev/gpiochip1 2".
  std::string taken(const GpioLineSettings& settings) {
    const auto line = GpioLineRequest(*chips_, settings).input();
    for (const auto& [device, chip] : fake_.chips) {
      for (std::size_t offset = 0; offset < chip.lines.size(); ++offset) {
        if (chip.lines[offset].consumer == "biotomyd") {
          return device + " " + std::to_string(offset);
        }
      }
    }
    return "none";
  }

  std::string refusal(const GpioLineSettings& settings) {
    return thrown_message<DeviceError>([&] { GpioLineRequest(*chips_, settings).input(); });
  }

  FakeGpioChips::Line& estop() { return fake_.chips["/dev/gpiochip1"].lines[0]; }

  FakeGpioChips fake_;
  std::unique_ptr<GpioChips> chips_ = fake_.make();
};

TEST_F(GpioLineRequestOnChips, FindsTheChipByPathNameAndLabel) {
  for (const char* chip : {"/dev/gpiochip1", "gpiochip1", "rig"}) {
    EXPECT_EQ(taken({.chip = chip, .line = "DOOR"}), "/dev/gpiochip1 1");
  }
}

TEST_F(GpioLineRequestOnChips, FindsTheLineByNameAndByOffset) {
  EXPECT_EQ(taken({.chip = "rig", .line = "ESTOP"}), "/dev/gpiochip1 0");
  EXPECT_EQ(taken({.chip = "rig", .line = "1"}), "/dev/gpiochip1 1");
}

TEST_F(GpioLineRequestOnChips, PrefersANameThatIsANumberToTheOffset) {
  EXPECT_EQ(taken({.chip = "rig", .line = "0"}), "/dev/gpiochip1 2");
}

TEST_F(GpioLineRequestOnChips, ReleasesTheLineWithTheObject) {
  taken({.chip = "rig", .line = "DOOR"});
  EXPECT_EQ(taken({.chip = "rig", .line = "DOOR"}), "/dev/gpiochip1 1");
}

TEST_F(GpioLineRequestOnChips, ListsTheChipsThereAreWhenThereIsNoSuchOne) {
  EXPECT_THAT(refusal({.chip = "rgi", .line = "ESTOP"}),
              AllOf(StartsWith("line ESTOP of GPIO chip rgi: there is no chip"),
                    HasSubstr("gpiochip0 (label \"board\", 3 lines)"), HasSubstr("gpiochip1")));
  EXPECT_THAT(refusal({.chip = "/dev/gpiochip7", .line = "ESTOP"}),
              AllOf(HasSubstr("no such file"), HasSubstr("gpiochip1 (label \"rig\", 3 lines)")));
}

TEST_F(GpioLineRequestOnChips, SaysWhenThereIsNoChipAtAll) {
  fake_.chips.clear();
  EXPECT_THAT(refusal({.chip = "rig", .line = "ESTOP"}), HasSubstr("this computer has none"));
}

TEST_F(GpioLineRequestOnChips, WantsAPathWhenTwoChipsHaveTheLabel) {
  fake_.chips["/dev/gpiochip0"].label = "rig";
  EXPECT_THAT(refusal({.chip = "rig", .line = "ESTOP"}), HasSubstr("more than one chip"));
}

TEST_F(GpioLineRequestOnChips, NamesTheGroupWhenTheChipMayNotBeOpened) {
  fake_.chips["/dev/gpiochip1"].open_error = EACCES;
  for (const char* chip : {"/dev/gpiochip1", "gpiochip1", "rig"}) {
    EXPECT_THAT(refusal({.chip = chip, .line = "ESTOP"}),
                AllOf(HasSubstr("/dev/gpiochip1"), HasSubstr("group gpio")));
  }
}

TEST_F(GpioLineRequestOnChips, DoesNotCareForAChipThatItDoesNotNeed) {
  fake_.chips["/dev/gpiochip0"].open_error = EACCES;
  EXPECT_EQ(taken({.chip = "rig", .line = "ESTOP"}), "/dev/gpiochip1 0");
}

TEST_F(GpioLineRequestOnChips, SaysWhenAPathIsNoChip) {
  fake_.chips["/dev/gpiochip1"].open_error = ENOTTY;
  EXPECT_THAT(refusal({.chip = "/dev/gpiochip1", .line = "ESTOP"}),
              HasSubstr("cannot be opened as a GPIO chip"));
}

TEST_F(GpioLineRequestOnChips, SuggestsTheNearestNameOfALine) {
  EXPECT_THAT(refusal({.chip = "rig", .line = "ESTPO"}),
              AllOf(HasSubstr("did you mean \"ESTOP\"?"), HasSubstr("0 to 2")));
  EXPECT_THAT(refusal({.chip = "rig", .line = "3"}), HasSubstr("no line of that name or offset"));
  EXPECT_THAT(refusal({.chip = "rig", .line = "1x"}), HasSubstr("no line of that name or offset"));
}

TEST_F(GpioLineRequestOnChips, WantsAnOffsetWhenTwoLinesHaveTheName) {
  fake_.chips["/dev/gpiochip1"].lines[1].name = "ESTOP";
  EXPECT_THAT(refusal({.chip = "rig", .line = "ESTOP"}), HasSubstr("one of 0, 1"));
}

TEST_F(GpioLineRequestOnChips, NamesWhoHoldsTheLine) {
  estop().consumer = "door-watch";
  EXPECT_THAT(refusal({.chip = "rig", .line = "ESTOP"}), HasSubstr("is held by \"door-watch\""));
}

TEST_F(GpioLineRequestOnChips, SaysThatTwoRolesHaveTheSameLine) {
  const auto held = GpioLineRequest(*chips_, {.chip = "rig", .line = "ESTOP"}).input();
  EXPECT_THAT(refusal({.chip = "rig", .line = "ESTOP"}), HasSubstr("another of the roles"));
}

TEST_F(GpioLineRequestOnChips, SaysThatTheBiasCannotBeHad) {
  estop().request_error = EINVAL;
  EXPECT_THAT(refusal({.chip = "rig", .line = "ESTOP", .bias = LineBias::pull_up}),
              AllOf(HasSubstr("bias pull-up"), HasSubstr("as-is")));
  EXPECT_THAT(refusal({.chip = "rig", .line = "ESTOP"}), HasSubstr("cannot be had"));
}

TEST_F(GpioLineRequestOnChips, SaysThatTheLineHasNoEdges) {
  estop().request_error = ENXIO;
  EXPECT_THAT(refusal({.chip = "rig", .line = "ESTOP"}), HasSubstr("edges = false"));
  EXPECT_THAT(refusal({.chip = "rig", .line = "ESTOP", .edges = false}),
              AllOf(HasSubstr("cannot be had"), ::testing::Not(HasSubstr("edges"))));
}

TEST_F(GpioLineRequestOnChips, RefusesAnotherChipThatGotTheNumberOfTheLostOne) {
  GpioLineRequest request(*chips_, {.chip = "gpiochip1", .line = "0"});
  request.input();
  request.input();
  std::swap(fake_.chips["/dev/gpiochip0"], fake_.chips["/dev/gpiochip1"]);
  EXPECT_THAT(thrown_message<DeviceError>([&] { request.input(); }),
              AllOf(HasSubstr("another chip"), HasSubstr("\"board\" in place of \"rig\"")));
}

}  // namespace
}  // namespace biotomy::bridge
