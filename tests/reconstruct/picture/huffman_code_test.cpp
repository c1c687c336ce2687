#include "reconstruct/picture/huffman_code.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

/// Σ 2^−length over the symbols that have a code: 1 for a code without a gap.
double kraft_sum(const HuffmanCode& code) {
  double sum = 0.0;
  for (const std::uint8_t length : code.lengths) {
    sum += length > 0 ? 1.0 / static_cast<double>(1U << length) : 0.0;
  }
  return sum;
}

TEST(HuffmanCode, IsTheOneOfTheTextbook) {
  const std::vector<std::uint32_t> counts{45, 13, 12, 16, 9, 5};
  EXPECT_EQ(huffman_code(counts, 15).lengths, (std::vector<std::uint8_t>{1, 3, 3, 3, 4, 4}));
}

// RFC 1951, 3.2.2, whose codes are 010, 011, 100, 101, 110, 00, 1110, 1111, highest bit first.
TEST(HuffmanCode, IsNumberedAsTheExampleOfTheRfc) {
  const std::vector<std::uint32_t> counts{8, 8, 8, 8, 8, 16, 4, 4};
  const HuffmanCode code = huffman_code(counts, 15);
  ASSERT_EQ(code.lengths, (std::vector<std::uint8_t>{3, 3, 3, 3, 3, 2, 4, 4}));
  EXPECT_EQ(code.codes,
            (std::vector<std::uint16_t>{0b010, 0b110, 0b001, 0b101, 0b011, 0b00, 0b0111, 0b1111}));
}

TEST(HuffmanCode, GivesASymbolThatIsAloneOneBit) {
  const std::vector<std::uint32_t> counts{0, 7, 0};
  EXPECT_EQ(huffman_code(counts, 15).lengths, (std::vector<std::uint8_t>{0, 1, 0}));
  EXPECT_EQ(huffman_code(std::vector<std::uint32_t>(3, 0), 15).lengths,
            (std::vector<std::uint8_t>{0, 0, 0}));
}

TEST(HuffmanCode, KeepsItsLimitWhereTheShortestCodeWouldNot) {
  std::vector<std::uint32_t> fibonacci{1, 1};
  while (fibonacci.size() < 30) {
    fibonacci.push_back(fibonacci[fibonacci.size() - 1] + fibonacci[fibonacci.size() - 2]);
  }
  for (const int longest : {7, 12, 15}) {
    const HuffmanCode code = huffman_code(fibonacci, longest);
    EXPECT_LE(*std::max_element(code.lengths.begin(), code.lengths.end()), longest);
    EXPECT_EQ(kraft_sum(code), 1.0);
  }
}

TEST(HuffmanCode, HasNoGapsAndNoLongerCodesForWhatIsMoreFrequent) {
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::uint32_t> counts(286);
    for (std::uint32_t& count : counts) {
      count = random() % 3 == 0 ? 0 : 1U << random() % 20;
    }
    counts[0] = counts[1] = 1;
    const HuffmanCode code = huffman_code(counts, 12);
    EXPECT_EQ(kraft_sum(code), 1.0);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      EXPECT_EQ(code.lengths[i] == 0, counts[i] == 0);
      for (std::size_t k = 0; k < i; ++k) {
        if (counts[i] > counts[k] && counts[k] > 0) {
          ASSERT_LE(code.lengths[i], code.lengths[k]);
        }
      }
    }
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
