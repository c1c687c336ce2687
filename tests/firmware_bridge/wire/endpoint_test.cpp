#include "firmware_bridge/wire/endpoint.hpp"

#include <gtest/gtest.h>

namespace biotomy::bridge {
namespace {

TEST(Endpoint, ReadsEveryForm) {
  const Endpoint tcp = parse_endpoint("tcp://127.0.0.1:1502");
  EXPECT_EQ(tcp.scheme, Endpoint::Scheme::tcp);
  EXPECT_EQ(tcp.host, "127.0.0.1");
  EXPECT_EQ(tcp.port, 1502);
  EXPECT_EQ(parse_endpoint("tcp://[::1]:502").host, "::1");
  EXPECT_EQ(parse_endpoint("unix:///run/rig.sock").path, "/run/rig.sock");
  EXPECT_EQ(parse_endpoint("unix://rig.sock").path, "rig.sock");
  EXPECT_EQ(parse_endpoint("rtu:///dev/ttyUSB0").scheme, Endpoint::Scheme::rtu);
}

TEST(Endpoint, IsWrittenAsItWasRead) {
  for (const char* text : {"tcp://plc:502", "tcp://[fe80::1]:0", "unix://a b", "rtu:///dev/x"}) {
    EXPECT_EQ(to_string(parse_endpoint(text)), text);
  }
}

TEST(Endpoint, RefusesWhatIsNone) {
  for (const char* text : {"", "127.0.0.1:502", "tcp://plc", "tcp://:502", "tcp://plc:", "unix://",
                           "tcp://plc:65536", "tcp://plc:-1", "tcp://plc:5a", "tcp://::1:502"}) {
    EXPECT_THROW(parse_endpoint(text), ConfigurationError) << text;
  }
}

}  // namespace
}  // namespace biotomy::bridge
