#include "firmware_bridge/camera/socket_camera.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/wire/shared_frame.hpp"
#include "tests/firmware_bridge/fake_rig.hpp"

namespace biotomy::bridge {
namespace {

using namespace std::chrono_literals;
using testing::FakeRig;
using Kind = DeviceError::Kind;

/// A 4 × 2 camera whose pixel bytes count up along the memory.
struct FakeCamera {
  FrameMessage frame{.width = 4,
                     .height = 2,
                     .stride = 16,
                     .format = RigPixelFormat::rgb888,
                     .sequence = 5,
                     .timestamp_ns = 1000,
                     .exposure_us = 250.4,
                     .gain = 2};
  std::size_t memory_size = 32;
  bool with_memory = true;

  RigAnswer operator()(const RigMessage& request) const {
    if (std::holds_alternative<ConfigureMessage>(request)) return {.message = ConfiguredMessage{}};
    FrameMemory memory(memory_size);
    for (std::size_t i = 0; i < memory_size; ++i) memory.bytes()[i] = std::byte(i);
    RigAnswer answer{.message = frame};
    if (with_memory) answer.descriptor = memory.seal();
    return answer;
  }
};

template <class Act>
Kind kind_of_failure(Act act) {
  try {
    act();
  } catch (const DeviceError& error) {
    return error.kind();
  }
  ADD_FAILURE() << "nothing was thrown";
  return Kind::configuration;
}

TEST(SocketCamera, TellsWhatItIs) {
  FakeRig rig(FakeCamera{});
  SocketCamera camera(rig.path(), 5s);
  const CameraDescription description = camera.describe();
  EXPECT_EQ(description.model, "fake");
  EXPECT_EQ(description.width, 4);
  EXPECT_EQ(description.height, 2);
  EXPECT_EQ(description.transfer, Transfer::srgb);
}

TEST(SocketCamera, TellsHowItsValuesFollowTheLight) {
  FakeRig rig(FakeCamera{});
  rig.welcome.camera->transfer = Transfer::linear;
  SocketCamera camera(rig.path(), 5s);
  EXPECT_EQ(camera.describe().transfer, Transfer::linear);
}

TEST(SocketCamera, GivesTheFrameRowByRowWithItsFacts) {
  FakeRig rig(FakeCamera{});
  SocketCamera camera(rig.path(), 5s);
  const Frame frame = camera.capture(5s);
  ASSERT_EQ(frame.image.size(), cv::Size(4, 2));
  ASSERT_EQ(frame.image.type(), CV_8UC3);
  EXPECT_EQ(frame.image.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 1, 2));
  EXPECT_EQ(frame.image.at<cv::Vec3b>(1, 3), cv::Vec3b(25, 26, 27));
  EXPECT_EQ(frame.sequence, 5U);
  EXPECT_EQ(frame.sensor_timestamp, 1000ns);
  EXPECT_EQ(frame.exposure, 250us);
  EXPECT_EQ(frame.gain, 2.0);
}

TEST(SocketCamera, RefusesToDriveALensAndHasNone) {
  FakeRig rig(FakeCamera{});
  SocketCamera camera(rig.path(), 5s);
  EXPECT_FALSE(camera.describe().lens);
  EXPECT_EQ(kind_of_failure([&] { camera.apply({.lens_position = 4.0}); }), Kind::refused);
}

TEST(SocketCamera, GivesSixteenBitFrames) {
  FakeCamera fake;
  fake.frame.format = RigPixelFormat::rgb161616;
  fake.frame.stride = 24;
  fake.memory_size = 48;
  FakeRig rig(fake);
  SocketCamera camera(rig.path(), 5s);
  const Frame frame = camera.capture(5s);
  ASSERT_EQ(frame.image.type(), CV_16UC3);
  EXPECT_EQ(frame.image.at<cv::Vec3w>(1, 0), cv::Vec3w(0x1918, 0x1B1A, 0x1D1C));
}

TEST(SocketCamera, RefusesAFrameWhoseMemoryIsMissingOrTooSmall) {
  FakeCamera without;
  without.with_memory = false;
  FakeCamera small;
  small.memory_size = 31;
  for (const FakeCamera& fake : {without, small}) {
    FakeRig rig(fake);
    SocketCamera camera(rig.path(), 5s);
    EXPECT_EQ(kind_of_failure([&] { camera.capture(5s); }), Kind::disconnected);
  }
}

TEST(SocketCamera, RefusesAFrameOfAnotherSizeThanTheCameras) {
  FakeCamera fake;
  fake.frame.height = 1;
  FakeRig rig(fake);
  SocketCamera camera(rig.path(), 5s);
  EXPECT_EQ(kind_of_failure([&] { camera.capture(5s); }), Kind::refused);
}

TEST(SocketCamera, AppliesItsSettingsAgainAfterARestart) {
  FakeRig rig(FakeCamera{});
  SocketCamera camera(rig.path(), 5s);
  camera.apply({.exposure = 1500us, .gain = 3, .red_gain = 1.5, .blue_gain = 2});
  camera.capture(5s);
  rig.stop();
  EXPECT_EQ(kind_of_failure([&] { camera.capture(5s); }), Kind::disconnected);
  rig.start();
  camera.capture(5s);
  const auto asked = rig.asked();
  EXPECT_EQ(std::count_if(asked.begin(), asked.end(),
                          [](const RigMessage& message) {
                            const auto* settings = std::get_if<ConfigureMessage>(&message);
                            return settings != nullptr && settings->exposure_us == 1500 &&
                                   settings->gain == 3;
                          }),
            2);
}

TEST(SocketCamera, TellsThatThereIsNoFrameInTime) {
  FakeRig rig(FakeCamera{});
  SocketCamera camera(rig.path(), 5s);
  camera.describe();
  rig.is_silent = true;
  EXPECT_EQ(kind_of_failure([&] { camera.capture(5ms); }), Kind::timeout);
}

}  // namespace
}  // namespace biotomy::bridge
