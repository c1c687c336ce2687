#include "firmware_bridge/wire/nearest_name.hpp"

#include <gtest/gtest.h>

namespace biotomy::bridge {
namespace {

TEST(NearestName, FindsTheNameWithATypingMistake) {
  const std::vector<std::string> names = {"exposure_us", "gain", "red_gain"};
  EXPECT_EQ(nearest_name("exposre_us", names), "exposure_us");
  EXPECT_EQ(nearest_name("gian", names), "gain");
}

TEST(NearestName, FindsNothingForAStrangersName) {
  EXPECT_EQ(nearest_name("temperature", {"gain", "exposure_us"}), "");
  EXPECT_EQ(nearest_name(std::string(100000, 'x'), {"gain"}), "");
  EXPECT_EQ(nearest_name("gain", {}), "");
}

}  // namespace
}  // namespace biotomy::bridge
