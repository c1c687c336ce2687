#include "reconstruct/store/crc32c.hpp"

#include <random>
#include <string>
#include <vector>

#include <boost/crc.hpp>
#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

using ReferenceCrc = boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true>;

TEST(Crc32c, GivesThePublishedCheckValue) {
  const std::string digits = "123456789";
  EXPECT_EQ(crc32c(std::as_bytes(std::span(digits))), 0xE3069283U);
}

TEST(Crc32c, GivesWhatRfc3720SaysOf32Zeros) {
  const std::vector<std::byte> zeros(32);
  EXPECT_EQ(crc32c(zeros), 0x8A9136AAU);
}

TEST(Crc32c, AgreesWithBoostAtEveryLengthAndAlignment) {
  std::mt19937 random(7);
  std::vector<std::byte> bytes(600);
  for (std::byte& byte : bytes) {
    byte = static_cast<std::byte>(random());
  }
  for (std::size_t start = 0; start < 9; ++start) {
    for (std::size_t length = 0; start + length <= bytes.size(); ++length) {
      const auto part = std::span(bytes).subspan(start, length);
      ReferenceCrc reference;
      reference.process_bytes(part.data(), part.size());
      ASSERT_EQ(crc32c(part), reference.checksum()) << start << ' ' << length;
    }
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
