#include "acquisition/http/listen_address.hpp"

#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;

TEST(ListenAddress, IsAHostAndAPort) {
  EXPECT_EQ(parse_listen_address("127.0.0.1:8080")->host, "127.0.0.1");
  EXPECT_EQ(parse_listen_address("[::1]:0")->host, "::1");
  EXPECT_EQ(parse_listen_address("[::1]:0")->port, 0);
  EXPECT_EQ(parse_listen_address("rig.lab:80")->port, 80);
  for (const char* text : {"", "x", "8080", ":8080", "a:b", "a:65536", "::1:80"}) {
    EXPECT_FALSE(parse_listen_address(text)) << text;
  }
}

TEST(ListenAddress, IsALoopbackOnlyWhereNoOtherComputerReachesIt) {
  for (const char* host : {"localhost", "::1", "127.0.0.1", "127.8.9.10"}) {
    EXPECT_TRUE(is_loopback(host)) << host;
  }
  for (const char* host : {"0.0.0.0", "::", "192.168.7.20", "rig.lab", "128.0.0.1", ""}) {
    EXPECT_FALSE(is_loopback(host)) << host;
  }
}

TEST(ListenAddress, IsWrittenAsBrowsersTakeIt) {
  EXPECT_EQ(http_url("127.0.0.1", 8080), "http://127.0.0.1:8080");
  EXPECT_EQ(http_url("::1", 80), "http://[::1]:80");
}

}  // namespace
}  // namespace biotomy::tests
