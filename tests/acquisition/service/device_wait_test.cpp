#include "acquisition/service/device_wait.hpp"

#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/notify_socket.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using bridge::DeviceError;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A wait whose time passes in its pauses alone.
struct DeviceWaitTest : testing::Test {
  ServiceManager systemd;
  TimePoint now{};
  int tries = 0;
  int missing_tries = 0;  ///< so many find no device
  bool is_ended = false;

  DeviceWait wait(seconds limit) {
    return {limit, systemd, [this] { return now; },
            [this](milliseconds time) {
              now += time;
              return is_ended;
            }};
  }

  auto maker() {
    return [this]() -> std::unique_ptr<int> {
      if (++tries > missing_tries) return std::make_unique<int>(tries);
      throw DeviceError(DeviceError::Kind::configuration, "camera: libcamera finds none");
    };
  }
};

TEST_F(DeviceWaitTest, TakesADeviceThatIsThere) {
  EXPECT_EQ(*wait(seconds(0)).device(maker()), 1);
  EXPECT_EQ(now, TimePoint{});
}

TEST_F(DeviceWaitTest, TriesAgainUntilTheDeviceIsThere) {
  missing_tries = 5;
  EXPECT_EQ(*wait(seconds(60)).device(maker()), 6);
  EXPECT_LT(now - TimePoint{}, seconds(60));
}

TEST_F(DeviceWaitTest, GivesUpWhenTheTimeForAllDevicesIsOver) {
  DeviceWait both = wait(seconds(60));
  missing_tries = 10;
  both.device(maker());
  missing_tries = 1000;
  EXPECT_THAT([&] { both.device(maker()); },
              ThrowsMessage<DeviceError>(HasSubstr("libcamera finds none")));
  EXPECT_GE(now - TimePoint{}, seconds(60));
  EXPECT_LT(now - TimePoint{}, seconds(65));
}

TEST_F(DeviceWaitTest, FailsAtOnceWhenThereIsNoTime) {
  missing_tries = 1;
  EXPECT_THAT([&] { wait(seconds(0)).device(maker()); },
              ThrowsMessage<DeviceError>(HasSubstr("libcamera finds none")));
  EXPECT_EQ(now, TimePoint{});
}

TEST_F(DeviceWaitTest, GivesNoneWhenTheDaemonIsToEnd) {
  missing_tries = 1000;
  is_ended = true;
  EXPECT_EQ(wait(seconds(60)).device(maker()), nullptr);
  EXPECT_EQ(tries, 1);
}

TEST_F(DeviceWaitTest, DoesNotWaitForAConfigurationToMendItself) {
  EXPECT_THROW(wait(seconds(60)).device([]() -> std::unique_ptr<int> {
    throw std::invalid_argument("no such host");
  }),
               std::invalid_argument);
  EXPECT_EQ(now, TimePoint{});
}

TEST_F(DeviceWaitTest, TellsSystemdWhatIsMissingAndAsksForTimeAtEachTry) {
  const TemporaryFolder folder;
  NotifySocket socket(folder / "notify");
  missing_tries = 4;
  wait(seconds(60)).device(maker());
  EXPECT_TRUE(socket.await("EXTEND_TIMEOUT_USEC=", seconds(60), 3));
  EXPECT_EQ(socket.count("STATUS=waits for a device: camera: libcamera finds none"), 1U);
}

}  // namespace
}  // namespace biotomy::tests
