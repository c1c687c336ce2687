#include "reconstruct/picture/strip_deflate.hpp"

#include <algorithm>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

namespace biotomy::reconstruct {
namespace {

using Plain = std::vector<std::uint8_t>;

/// What zlib makes of a raw stream, and whether it came to the stream's end with the last byte.
struct Inflated {
  Plain plain;
  bool complete = false;
};

Inflated inflated(const std::vector<std::byte>& stream, std::size_t room, int window_bits) {
  Inflated result{Plain(room + 1), false};
  z_stream state{};
  EXPECT_EQ(inflateInit2(&state, window_bits), Z_OK);
  state.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(stream.data()));
  state.avail_in = static_cast<uInt>(stream.size());
  state.next_out = result.plain.data();
  state.avail_out = static_cast<uInt>(result.plain.size());
  const int code = inflate(&state, Z_FINISH);
  result.complete = code == Z_STREAM_END && state.avail_in == 0;
  result.plain.resize(state.total_out);
  inflateEnd(&state);
  return result;
}

void expect_round_trip(const Plain& plain) {
  std::vector<std::byte> stream;
  deflate_strip(plain, true, stream);
  const Inflated back = inflated(stream, plain.size(), -15);
  EXPECT_TRUE(back.complete) << plain.size();
  EXPECT_EQ(back.plain, plain);
  EXPECT_LE(stream.size(), plain.size() + plain.size() / 1000 + 64);
}

/// Noise around zero of a spread, as filters leave it, with runs in it.
Plain filtered_noise(std::size_t size, int spread, unsigned runs, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, spread);
  Plain plain;
  while (plain.size() < size) {
    if (runs > 0 && random() % runs == 0) {
      plain.insert(plain.end(), random() % 700, static_cast<std::uint8_t>(random()));
    }
    plain.push_back(static_cast<std::uint8_t>(static_cast<int>(normal(random))));
  }
  plain.resize(size);
  return plain;
}

TEST(StripDeflate, IsReadBackByZlib) {
  unsigned seed = 0;
  for (const std::size_t size : {0U, 1U, 2U, 3U, 4U, 5U, 100U, 65534U, 65535U, 65536U, 200'000U}) {
    for (const int spread : {1, 5, 1000}) {
      for (const unsigned runs : {0U, 3U, 50U}) {
        expect_round_trip(filtered_noise(size, spread, runs, ++seed));
      }
    }
  }
}

TEST(StripDeflate, WritesRunsOfEveryLength) {
  for (std::size_t length = 1; length < 600; ++length) {
    Plain plain(length, 7);
    plain.push_back(9);
    plain.insert(plain.begin(), 8);
    expect_round_trip(plain);
  }
}

TEST(StripDeflate, MakesNextToNothingOfAnEvenArea) {
  std::vector<std::byte> stream;
  deflate_strip(Plain(10'000'000, 0), true, stream);
  EXPECT_LT(stream.size(), 10'000'000U / 500);
}

TEST(StripDeflate, IsNearTheEntropyOfNoise) {
  const Plain plain = filtered_noise(1'000'000, 4, 0, 1);
  std::vector<std::byte> stream;
  deflate_strip(plain, true, stream);
  // A normal distribution of this spread, cut to whole numbers, has about 4.1 bits.
  EXPECT_LT(static_cast<double>(stream.size()) * 8.0 / static_cast<double>(plain.size()), 4.2);
}

TEST(StripDeflate, PiecesJoinToOneStream) {
  const Plain plain = filtered_noise(300'000, 3, 40, 5);
  std::vector<std::byte> stream;
  for (const auto& [begin, end] : {std::pair{0, 1000}, {1000, 1000}, {1000, 250'000}}) {
    deflate_strip({plain.data() + begin, plain.data() + end}, false, stream);
  }
  deflate_strip({plain.data() + 250'000, plain.data() + 300'000}, true, stream);
  const Inflated back = inflated(stream, plain.size(), -15);
  EXPECT_TRUE(back.complete);
  EXPECT_EQ(back.plain, plain);
}

TEST(StripDeflate, MakesAZlibStreamWithItsChecksum) {
  const Plain plain = filtered_noise(70'000, 3, 40, 6);
  std::vector<std::byte> stream = zlib_stream(plain);
  EXPECT_EQ(inflated(stream, plain.size(), 15).plain, plain);
  EXPECT_TRUE(inflated(stream, plain.size(), 15).complete);
  stream.back() ^= std::byte{1};
  EXPECT_FALSE(inflated(stream, plain.size(), 15).complete);
}

}  // namespace
}  // namespace biotomy::reconstruct
