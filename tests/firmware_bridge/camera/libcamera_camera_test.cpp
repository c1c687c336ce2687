#include "firmware_bridge/camera/libcamera_camera.hpp"

#include <gtest/gtest.h>

#include "firmware_bridge/camera/libcamera_listing.hpp"
#include "firmware_bridge/device_error.hpp"

namespace biotomy::bridge {
namespace {

TEST(LibcameraCamera, NamesTheCameraThatIsNotThere) {
  try {
    const LibcameraCamera camera(LibcameraSettings{.camera = "no-such-camera"});
    FAIL() << "nothing was thrown";
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.kind(), DeviceError::Kind::configuration);
  }
}

TEST(LibcameraCamera, SaysThatThereIsNoneWhereThereIsNone) {
  if (!list_libcamera_cameras().empty()) GTEST_SKIP() << "this computer has a camera";
  try {
    const LibcameraCamera camera(LibcameraSettings{});
    FAIL() << "nothing was thrown";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("finds none on this computer"), std::string::npos);
  }
}

}  // namespace
}  // namespace biotomy::bridge
