// A USB camera that is plugged in, looked through, and pulled out.
#include <chrono>
#include <csignal>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "firmware_bridge/camera/libcamera_camera.hpp"
#include "firmware_bridge/camera/libcamera_listing.hpp"
#include "firmware_bridge/device_error.hpp"
#include "tests/kernel/plugged_camera.hpp"

namespace biotomy::tests {
namespace {

using bridge::DeviceError;
using bridge::LibcameraCamera;
using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::Contains;
using testing::Field;

/// A picture that no other number has, with edges and slopes.
cv::Mat picture(int width, int height, int number) {
  cv::Mat image(height, width, CV_8UC3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at<cv::Vec3b>(y, x) = {static_cast<uchar>(255 * x / width),
                                   static_cast<uchar>(255 * y / height),
                                   static_cast<uchar>(40 * number)};
    }
  }
  const cv::Point centre(width / 6 * number, height / 2);
  cv::circle(image, centre, height / 8, cv::Scalar(250, 30, 60), cv::FILLED);
  return image;
}

bool are_equal(const cv::Mat& one, const cv::Mat& other) {
  return one.size() == other.size() && one.type() == other.type() &&
         cv::norm(one, other, cv::NORM_INF) == 0.0;
}

bridge::LibcameraSettings settings(int width, int height) {
  bridge::LibcameraSettings settings;
  settings.camera = kUsbModel;
  settings.width = width;
  settings.height = height;
  return settings;
}

class UsbCameraTest : public testing::Test {
 protected:
  UsbCameraTest() {
    usb_.show({picture(640, 480, 1)});
    usb_.plug_in();
  }

  /// How the camera fails now, or nothing when it gives a frame.
  static std::optional<DeviceError::Kind> failure(LibcameraCamera& camera, milliseconds time_out) {
    try {
      camera.capture(time_out);
      return std::nullopt;
    } catch (const DeviceError& error) {
      std::cout << error.what() << std::endl;
      return error.kind();
    }
  }

  PluggedCamera usb_;
};

TEST_F(UsbCameraTest, IsListed) {
  EXPECT_THAT(bridge::list_libcamera_cameras(),
              Contains(Field(&bridge::ListedCamera::model, kUsbModel)));
}

TEST_F(UsbCameraTest, ShowsWhatItSees) {
  const std::vector<cv::Mat> pictures{picture(640, 480, 1), picture(640, 480, 2),
                                      picture(640, 480, 3)};
  usb_.show(pictures);
  LibcameraCamera camera(settings(640, 480));
  for (int i = 0; i < 5; ++i) {
    const bridge::Frame frame = camera.capture(seconds(30));
    const auto shown = std::count_if(pictures.begin(), pictures.end(), [&](const cv::Mat& one) {
      return are_equal(frame.image, as_sent(one));
    });
    EXPECT_EQ(shown, 1) << "capture " << i;
  }
}

TEST_F(UsbCameraTest, ShowsEachSizeThatItOffers) {
  usb_.show({picture(640, 480, 2), picture(320, 240, 4)});
  for (const cv::Mat& expected : {picture(640, 480, 2), picture(320, 240, 4)}) {
    LibcameraCamera camera(settings(expected.cols, expected.rows));
    EXPECT_EQ(camera.describe().width, expected.cols);
    EXPECT_TRUE(are_equal(camera.capture(seconds(30)).image, as_sent(expected)));
  }
}

TEST_F(UsbCameraTest, ShowsNothingFromBeforeTheCapture) {
  usb_.show({picture(640, 480, 1)});
  LibcameraCamera camera(settings(640, 480));
  camera.capture(seconds(30));
  usb_.show({picture(640, 480, 5)});
  std::this_thread::sleep_for(seconds(1));  // a frame that it takes now is of the new picture
  EXPECT_TRUE(are_equal(camera.capture(seconds(30)).image, as_sent(picture(640, 480, 5))));
}

TEST_F(UsbCameraTest, IsNotWaitedForWhenItSendsNothing) {
  usb_.show({});
  LibcameraCamera camera(settings(640, 480));
  const auto begin = steady_clock::now();
  EXPECT_EQ(failure(camera, seconds(3)), DeviceError::Kind::timeout);
  EXPECT_LT(steady_clock::now() - begin, seconds(20));
  usb_.show({picture(640, 480, 1)});
  EXPECT_EQ(failure(camera, seconds(30)), std::nullopt);
}

TEST_F(UsbCameraTest, IsMissedAtOnceWhenItIsPulledOutDuringACapture) {
  usb_.show({});
  LibcameraCamera camera(settings(640, 480));
  auto unplugging = std::async(std::launch::async, [this] {
    std::this_thread::sleep_for(seconds(1));
    usb_.unplug();
  });
  const auto begin = steady_clock::now();
  EXPECT_EQ(failure(camera, seconds(120)), DeviceError::Kind::disconnected);
  EXPECT_LT(steady_clock::now() - begin, seconds(30));
  unplugging.get();
}

TEST_F(UsbCameraTest, ShowsWhatItSeesAgainWhenItIsBack) {
  LibcameraCamera camera(settings(640, 480));
  for (int i = 2; i < 5; ++i) {
    camera.capture(seconds(30));
    usb_.unplug();
    EXPECT_EQ(failure(camera, seconds(5)), DeviceError::Kind::disconnected);
    usb_.show({picture(640, 480, i)});
    usb_.plug_in();
    // libcamera hears of it in its own time.
    const auto deadline = steady_clock::now() + seconds(30);
    while (failure(camera, seconds(5)) && steady_clock::now() < deadline) {
      std::this_thread::sleep_for(milliseconds(500));
    }
    EXPECT_TRUE(are_equal(camera.capture(seconds(30)).image, as_sent(picture(640, 480, i))));
  }
}

}  // namespace
}  // namespace biotomy::tests
