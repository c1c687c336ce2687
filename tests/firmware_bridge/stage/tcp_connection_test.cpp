#include "firmware_bridge/stage/tcp_connection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/wire/configuration_error.hpp"

namespace biotomy::bridge {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

template <int kError>
int always_fail(const char* /*host*/, const char* /*port*/, const addrinfo* /*wanted*/,
                addrinfo** /*found*/) {
  return kError;
}

TEST(TcpAddresses, TakeAHostThatNobodyKnowsForAWrongConfiguration) {
  EXPECT_THAT(([] { TcpAddresses("plc.lab", 502, always_fail<EAI_NONAME>); }),
              ThrowsMessage<ConfigurationError>(HasSubstr("host plc.lab: ")));
}

TEST(TcpAddresses, TakeANameServerThatDoesNotAnswerForADeviceThatIsMissing) {
  for (const auto look_up : {always_fail<EAI_AGAIN>, always_fail<EAI_FAIL>}) {
    try {
      TcpAddresses("plc.lab", 502, look_up);
      FAIL() << "nothing was thrown";
    } catch (const DeviceError& error) {
      EXPECT_EQ(error.kind(), DeviceError::Kind::disconnected);
      EXPECT_THAT(error.what(), HasSubstr("host plc.lab: "));
    }
  }
}

}  // namespace
}  // namespace biotomy::bridge
