#include "sim/control/rtu_frame.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace biotomy::sim {
namespace {

using Bytes = std::vector<std::uint8_t>;

// The specification's own example: function 7 to unit 2 (Modbus over Serial Line 1.02, 6.2.2).
TEST(RtuFrame, EndsWithTheCheckOfTheSpecification) {
  EXPECT_EQ(rtu_check(Bytes{0x02, 0x07}), 0x1241);
  EXPECT_TRUE(is_rtu_frame(Bytes{0x02, 0x07, 0x41, 0x12}));
}

TEST(RtuFrame, IsNoneWithAnyBitTurnedOver) {
  const Bytes frame{0x02, 0x07, 0x41, 0x12};
  for (std::size_t byte = 0; byte < frame.size(); ++byte) {
    for (int bit = 0; bit < 8; ++bit) {
      Bytes damaged = frame;
      damaged[byte] = static_cast<std::uint8_t>(damaged[byte] ^ (1U << bit));
      EXPECT_FALSE(is_rtu_frame(damaged)) << byte << '.' << bit;
    }
  }
  EXPECT_FALSE(is_rtu_frame(Bytes{0x02, 0x07}));
}

TEST(RtuFrame, TellsTheLengthOfARequestFromItsBeginning) {
  EXPECT_EQ(rtu_request_length(Bytes{1, 4}), 8U);
  EXPECT_EQ(rtu_request_length(Bytes{1, 16, 0, 1, 0, 7}), 0U);
  EXPECT_EQ(rtu_request_length(Bytes{1, 16, 0, 1, 0, 7, 14}), 23U);
  EXPECT_EQ(rtu_request_length(Bytes{1, 5}), 0U);
}

}  // namespace
}  // namespace biotomy::sim
