#include "firmware_bridge/lines/gpio_listing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/firmware_bridge/lines/fake_gpio_chips.hpp"

namespace biotomy::bridge {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(GpioListing, IsEmptyWithoutChips) {
  bridge::testing::FakeGpioChips fake;
  EXPECT_THAT(list_gpio_chips(*fake.make()), IsEmpty());
}

TEST(GpioListing, TellsOfEveryChipAndGoesOnAfterOneThatDoesNotAnswer) {
  bridge::testing::FakeGpioChips fake;
  fake.chips["/dev/nowhere/gpiochip0"] = {.label = "board", .lines = {}, .open_error = EIO};
  fake.chips["/dev/nowhere/gpiochip1"] = {.label = "expander", .lines = {{.name = "ESTOP"}}};
  const auto listed = list_gpio_chips(*fake.make());
  ASSERT_EQ(listed.size(), 2U);
  EXPECT_EQ(listed[0].chip.name, "gpiochip0");
  EXPECT_THAT(listed[0].trouble, HasSubstr("/dev/nowhere/gpiochip0 cannot be opened"));
  EXPECT_EQ(listed[1].trouble, "");
  EXPECT_EQ(listed[1].chip.label, "expander");
  EXPECT_EQ(listed[1].chip.lines.at(0).name, "ESTOP");
  EXPECT_EQ(fake.requests, 0);
}

}  // namespace
}  // namespace biotomy::bridge
