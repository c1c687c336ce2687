// The kernel's virtual camera: a sensor, a scaler and a media controller between, as on a board.
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "firmware_bridge/camera/libcamera_camera.hpp"
#include "firmware_bridge/camera/libcamera_listing.hpp"

namespace biotomy::tests {
namespace {

using bridge::LibcameraCamera;
using std::chrono::seconds;
using testing::Contains;
using testing::Field;

constexpr const char* kVimc = "platform/vimc.0 Sensor B";

/// Which of red, green and blue there is at a place.
std::string colours_at(const cv::Mat& image, int x) {
  constexpr int kThere = 60;  // of 191; its demosaicing is coarse
  const auto& pixel = image.at<cv::Vec3b>(image.rows / 2, x);
  std::string colours;
  for (int channel = 0; channel < 3; ++channel) {
    if (pixel[channel] > kThere) colours += "RGB"[channel];
  }
  return colours;
}

TEST(Vimc, ShowsItsBarsInTheirColours) {
  bridge::LibcameraSettings settings;
  settings.camera = kVimc;
  settings.width = 636;
  settings.height = 480;
  LibcameraCamera camera(settings);
  const cv::Mat image = camera.capture(seconds(30)).image;
  ASSERT_EQ(image.size(), cv::Size(636, 480));
  const std::vector<std::string> expected{"RGB", "RG", "GB", "G", "RB", "R", "B", ""};
  for (int bar = 0; bar < 8; ++bar) {
    EXPECT_EQ(colours_at(image, image.cols * (2 * bar + 1) / 16), expected[bar]) << "bar " << bar;
  }
}

TEST(Vimc, CountsItsFrames) {
  bridge::LibcameraSettings settings;
  settings.camera = kVimc;
  settings.width = 636;
  settings.height = 480;
  LibcameraCamera camera(settings);
  std::uint64_t last = 0;
  for (int i = 0; i < 10; ++i) {
    const bridge::Frame frame = camera.capture(seconds(30));
    if (i > 0) {
      EXPECT_GT(frame.sequence, last);
    }
    EXPECT_GT(frame.sensor_timestamp.count(), 0);
    last = frame.sequence;
  }
}

TEST(Vimc, IsListed) {
  EXPECT_THAT(bridge::list_libcamera_cameras(), Contains(Field(&bridge::ListedCamera::id, kVimc)));
}

}  // namespace
}  // namespace biotomy::tests
