#include "tests/bench/made_up_tissue.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "reconstruct/errors.hpp"

namespace biotomy::bench {
namespace {

constexpr std::int64_t kCellSide =
    24;  // no divisor of a chunk's side: chunks differ from each other
constexpr int kDarkest = 60;
constexpr std::uint64_t kLevels = 128;
constexpr int kMiddleOfNoise = 15;  // the mean of the sum of two numbers of 0 to 15

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): every bit of the result depends on every
/// bit of the argument.
std::uint64_t mixed(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9U;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebU;
  return bits ^ (bits >> 31);
}

std::uint64_t hash(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t what) {
  constexpr int kBitsOfAPlace = 20;
  const auto place = (static_cast<std::uint64_t>(z) << (2 * kBitsOfAPlace)) |
                     (static_cast<std::uint64_t>(y) << kBitsOfAPlace) |
                     static_cast<std::uint64_t>(x);
  return mixed(place * 4 + what);
}

std::array<std::uint8_t, 3> cell_colour(std::int64_t x, std::int64_t y, std::int64_t z) {
  const std::uint64_t bits = hash(x / kCellSide, y / kCellSide, z / kCellSide, 1);
  std::array<std::uint8_t, 3> colour{};
  for (std::size_t c = 0; c < colour.size(); ++c) {
    colour[c] = static_cast<std::uint8_t>(kDarkest + (bits >> (16 * c)) % kLevels);
  }
  return colour;
}

}  // namespace

MadeUpTissue::MadeUpTissue(double noisy)
    : noisy_of_65536_(static_cast<std::uint32_t>(std::lround(noisy * 65536))) {
  if (!(noisy >= 0.0 && noisy <= 1.0)) {
    throw reconstruct::InvalidRequest("the share of noisy voxels must be 0 to 1, not " +
                                      std::to_string(noisy));
  }
}

std::array<std::uint8_t, 3> MadeUpTissue::voxel(std::int64_t x, std::int64_t y,
                                                std::int64_t z) const {
  std::array<std::uint8_t, 3> colour{};
  row(x, y, z, 1, colour.data());
  return colour;
}

void MadeUpTissue::row(std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t count,
                       std::uint8_t* out) const {
  for (std::int64_t begin = x; begin < x + count;) {
    const std::int64_t end = std::min((begin / kCellSide + 1) * kCellSide, x + count);
    const std::array<std::uint8_t, 3> cell = cell_colour(begin, y, z);
    for (; begin < end; ++begin, out += 3) {
      const std::uint64_t bits = hash(begin, y, z, 0);
      const bool noisy = (bits & 0xffffU) < noisy_of_65536_;
      for (std::size_t c = 0; c < cell.size(); ++c) {
        const std::uint64_t own = bits >> (16 + 8 * c);
        const int noise = static_cast<int>((own & 15U) + ((own >> 4) & 15U)) - kMiddleOfNoise;
        out[c] = static_cast<std::uint8_t>(noisy ? cell[c] + noise / 3 : cell[c]);
      }
    }
  }
}

}  // namespace biotomy::bench
