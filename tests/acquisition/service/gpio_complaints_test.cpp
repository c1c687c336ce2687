#include "acquisition/service/gpio_complaints.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/firmware_bridge/lines/fake_gpio_chips.hpp"

namespace biotomy::tests {
namespace {

using acquisition::Complaints;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A chip with four lines, three of them wired.
struct GpioComplaints : testing::Test {
  bridge::testing::FakeGpioChips fake;
  bridge::GpiodLinesSettings settings;

  GpioComplaints() {
    fake.chips["/dev/gpiochip0"] = {
        .label = "board", .lines = {{.name = "ESTOP"}, {.name = ""}, {.name = ""}, {.name = ""}}};
    settings.estop.chip = settings.door.chip = settings.lamp.chip = "board";
    settings.estop.line = "ESTOP";
    settings.door.line = "1";
    settings.lamp.line = "2";
  }

  Complaints complaints() { return acquisition::gpio_complaints(settings, *fake.make()); }
};

TEST_F(GpioComplaints, AreNoneForLinesThatAreFree) {
  EXPECT_THAT(complaints(), IsEmpty());
  EXPECT_THAT(complaints(), IsEmpty()) << "the lines were not let go";
}

TEST_F(GpioComplaints, NameEveryLineThatCannotBeHad) {
  settings.estop.chip = "gpiochip7";
  settings.door.line = "99";
  fake.chips.at("/dev/gpiochip0").lines[2].consumer = "led";
  EXPECT_THAT(complaints(), ElementsAre(AllOf(StartsWith("lines.estop: "), HasSubstr("gpiochip7")),
                                        AllOf(StartsWith("lines.door: "), HasSubstr("99")),
                                        AllOf(StartsWith("lines.lamp: "), HasSubstr("\"led\""))));
}

TEST_F(GpioComplaints, RefuseOneLineForTwoRoles) {
  settings.tower_light = settings.lamp;
  EXPECT_THAT(complaints(), ElementsAre(AllOf(StartsWith("lines.tower_light: "),
                                              HasSubstr("another of the roles in [lines]"))));
}

}  // namespace
}  // namespace biotomy::tests
