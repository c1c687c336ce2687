#include "firmware_bridge/camera/camera_sync.hpp"

#include <memory>

#include <gtest/gtest.h>

#include "firmware_bridge/device_error.hpp"
#include "tests/firmware_bridge/lines/fake_gpio_chips.hpp"

namespace biotomy::bridge {
namespace {

using Mode = CameraSyncSettings::Mode;

class CameraSyncTest : public ::testing::Test {
 protected:
  CameraSyncTest() { chips_.chips[kDevice] = {.label = "fake", .lines = {{.name = "strobe"}}}; }

  std::unique_ptr<CameraSync> sync(Mode mode, bool active_low = false) {
    const GpioLineSettings line{.chip = "gpiochip0", .line = "strobe", .active_low = active_low};
    return std::make_unique<CameraSync>(
        CameraSyncSettings{.mode = mode, .line = line, .pulse = std::chrono::microseconds(1)},
        chips_.make());
  }
  const testing::FakeGpioChips::Line& line() const { return chips_.chips.at(kDevice).lines[0]; }

  static constexpr const char* kDevice = "/dev/gpiochip0";
  testing::FakeGpioChips chips_;
};

TEST_F(CameraSyncTest, NeedsNoLineWhenThereIsNothingToSynchronise) {
  const auto none = sync(Mode::none);
  none->begin_capture();
  none->trigger();
  none->end_capture();
  EXPECT_EQ(chips_.requests, 0);
}

TEST_F(CameraSyncTest, HoldsAStrobeForTheWholeCapture) {
  const auto strobe = sync(Mode::strobe);
  EXPECT_FALSE(strobe->is_trigger());
  strobe->begin_capture();
  strobe->trigger();
  EXPECT_TRUE(line().is_high);
  strobe->end_capture();
  EXPECT_FALSE(line().is_high);
  EXPECT_EQ(line().switched_on, 1);
}

TEST_F(CameraSyncTest, GivesOnePulseForEachTrigger) {
  const auto trigger = sync(Mode::trigger);
  EXPECT_TRUE(trigger->is_trigger());
  trigger->begin_capture();
  EXPECT_EQ(line().switched_on, 0);
  trigger->trigger();
  trigger->trigger();
  EXPECT_FALSE(line().is_high);
  EXPECT_EQ(line().switched_on, 2);
}

TEST_F(CameraSyncTest, IsInactiveAtTheEndWhateverThePolarity) {
  auto strobe = sync(Mode::strobe, true);
  EXPECT_TRUE(line().is_high);
  strobe->begin_capture();
  EXPECT_FALSE(line().is_high);
  strobe.reset();
  EXPECT_TRUE(line().is_high);
}

TEST_F(CameraSyncTest, SaysWhenTheLineIsGone) {
  const auto strobe = sync(Mode::strobe);
  chips_.unplug(kDevice);
  EXPECT_THROW(strobe->begin_capture(), DeviceError);
  EXPECT_NO_THROW(strobe->end_capture());
}

}  // namespace
}  // namespace biotomy::bridge
