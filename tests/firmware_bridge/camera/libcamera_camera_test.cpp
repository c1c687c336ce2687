#include "firmware_bridge/camera/libcamera_camera.hpp"

#include <gtest/gtest.h>
#include <libcamera/formats.h>

#include "firmware_bridge/camera/libcamera_format.hpp"
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

TEST(LibcameraFormats, OfFinishedColoursAreTakenForSrgb) {
  using namespace libcamera::formats;
  for (const auto& format : {BGR888, NV12, MJPEG}) {
    EXPECT_EQ(transfer_of(format, false), Transfer::srgb) << format.toString();
  }
  EXPECT_EQ(transfer_of(SRGGB12_CSI2P, true), Transfer::srgb);
  EXPECT_EQ(transfer_of(SRGGB12_CSI2P, false), Transfer::linear);
  EXPECT_EQ(transfer_of(SBGGR10, false), Transfer::linear);
}

}  // namespace
}  // namespace biotomy::bridge
