#include "firmware_bridge/lines/gpiod_lines.hpp"

#include <gtest/gtest.h>

#include "firmware_bridge/device_error.hpp"

namespace biotomy::bridge {
namespace {

TEST(GpiodLines, NameTheChipThatIsNotThere) {
  GpiodLinesSettings settings;
  settings.estop = {.chip = "no-such-chip", .line = "ESTOP"};
  try {
    const GpiodLines lines(settings);
    FAIL() << "nothing was thrown";
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.kind(), DeviceError::Kind::configuration);
    EXPECT_NE(std::string(error.what()).find("line ESTOP of GPIO chip no-such-chip"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace biotomy::bridge
