#include "firmware_bridge/camera/capture_time_out.hpp"

#include <gtest/gtest.h>

namespace biotomy::bridge {
namespace {

using namespace std::chrono_literals;

TEST(CaptureTimeOut, LetsACameraBeSilentForItsShareOfTheTimeOut) {
  EXPECT_EQ(longest_silence(6000ms, 10ms), 2000ms);
}

TEST(CaptureTimeOut, TakesNoCameraThatExposesForOneThatIsSilent) {
  EXPECT_EQ(longest_silence(5000ms, 2000ms), 8000ms);
}

TEST(CaptureTimeOut, LeavesThreeSessionsTheirTimeAtTheLeast) {
  for (const auto exposure : {1us, 10000us, 1666667us, 60000000us}) {
    const auto least = least_time_out(exposure);
    EXPECT_GE(least, 12 * exposure);
    EXPECT_LE(kSessionsOfACapture * longest_silence(least, exposure),
              least + std::chrono::milliseconds(kSessionsOfACapture));
  }
}

}  // namespace
}  // namespace biotomy::bridge
