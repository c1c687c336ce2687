#include "firmware_bridge/wire/transfer.hpp"

#include <gtest/gtest.h>

namespace biotomy::bridge {
namespace {

// IEC 61966-2-1: a linear 0.2140 is coded as 0.5, a linear 0.0021586 as 0.0278891.
TEST(Srgb, IsTheStandards) {
  EXPECT_NEAR(srgb_tables<std::uint16_t>().value[14027], 32768, 10);
  EXPECT_NEAR(srgb_tables<std::uint16_t>().value[141], 1822, 5);
  EXPECT_NEAR(srgb_tables<std::uint16_t>().light[32768], 14027, 1);
  EXPECT_NEAR(srgb_tables<std::uint16_t>().light[1822], 141, 1);
  EXPECT_EQ(srgb_tables<std::uint8_t>().value[14147], 128);
  EXPECT_NEAR(srgb_tables<std::uint8_t>().light[128], 14147, 1);
}

TEST(Srgb, LeavesBlackAndFullScaleWhereTheyAre) {
  EXPECT_EQ(srgb_tables<std::uint8_t>().light.front(), 0);
  EXPECT_EQ(srgb_tables<std::uint8_t>().light.back(), 65535);
  EXPECT_EQ(srgb_tables<std::uint8_t>().value.front(), 0);
  EXPECT_EQ(srgb_tables<std::uint8_t>().value.back(), 255);
  EXPECT_EQ(srgb_tables<std::uint16_t>().value.back(), 65535);
  EXPECT_EQ(srgb_tables<std::uint16_t>().light.back(), 65535);
  EXPECT_LT(srgb_tables<std::uint16_t>().light[65534], 65535) << "of a value that is not clipped";
}

TEST(Srgb, ThereAndBackIsNothing) {
  const SrgbTables<std::uint8_t>& eight = srgb_tables<std::uint8_t>();
  for (std::size_t value = 0; value < eight.light.size(); ++value) {
    EXPECT_EQ(eight.value[eight.light[value]], value);
  }
  // What `demosaic` codes.
  const SrgbTables<std::uint16_t>& sixteen = srgb_tables<std::uint16_t>();
  for (const std::uint16_t value : sixteen.value) {
    ASSERT_EQ(sixteen.value[sixteen.light[value]], value);
  }
}

}  // namespace
}  // namespace biotomy::bridge
