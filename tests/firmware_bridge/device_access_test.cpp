#include "firmware_bridge/device_access.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.hpp"

namespace biotomy::bridge {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::TemporaryFolder;

TEST(DeviceAccess, NamesTheGroupAndTheCommandForADeviceThatIsClosed) {
  EXPECT_EQ(no_access_text("/dev/ttyUSB0", "dialout", "anna"),
            "the user anna may not open /dev/ttyUSB0: it is for the group dialout; sudo usermod "
            "-aG dialout anna, then log in anew");
}

TEST(DeviceAccess, NamesTheRulesForADeviceOfRoot) {
  EXPECT_THAT(no_access_text("/dev/gpiochip0", "root", "anna"),
              HasSubstr("it belongs to root alone; install the udev rules"));
}

TEST(DeviceAccess, HasNothingAgainstADeviceThatIsOpenToUs) {
  EXPECT_EQ(access_complaint("/dev/null"), std::nullopt);
}

TEST(DeviceAccess, SaysThatADeviceIsNotThere) {
  EXPECT_EQ(access_complaint("/dev/nothing-of-that-name"),
            "/dev/nothing-of-that-name cannot be opened: No such file or directory");
}

TEST(DeviceAccess, FindsTheProgramThatHasADevice) {
  const TemporaryFolder folder;
  const fs::path device = fs::canonical(folder.path()) / "ttyUSB0";
  std::ofstream(device) << "";
  for (const char* process : {"412", "413"}) fs::create_directories(folder / process / "fd");
  std::ofstream(folder / "412/comm") << "ModemManager\n";
  fs::create_symlink(device, folder / "412/fd/7");
  fs::create_symlink("/dev/null", folder / "413/fd/7");
  fs::create_symlink(device, folder / "by-id");
  EXPECT_THAT(programs_with(device, folder.path()), ElementsAre("ModemManager (process 412)"));
  EXPECT_THAT(programs_with(folder / "by-id", folder.path()),
              ElementsAre("ModemManager (process 412)"));
  EXPECT_THAT(programs_with("/dev/nothing-of-that-name", folder.path()), IsEmpty());
}

}  // namespace
}  // namespace biotomy::bridge
