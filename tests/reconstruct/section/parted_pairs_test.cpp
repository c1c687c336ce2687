#include "reconstruct/section/parted_pairs.hpp"

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "reconstruct/bricks/texel_blocks.hpp"

namespace biotomy::reconstruct {
namespace {

template <typename Level>
class PartedPairsTest : public testing::Test {};

using BothDepths = testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(PartedPairsTest, BothDepths);

constexpr std::size_t kTexelLevels = TexelBlocks::kColours;

/// A row of pixels in noise, of which about `parted` of four are parted.
template <typename Level>
struct NoisyRow {
  static constexpr std::size_t kBytes = 20'000;

  std::mt19937 random;
  std::vector<std::byte> noise{kBytes};
  std::size_t count;
  PixelPlaces<Level> places;
  std::vector<std::array<std::array<std::vector<std::byte>, 2>, 2>> wanted;  // layer, row

  NoisyRow(std::size_t pixels, bool crosses, std::ptrdiff_t down, unsigned parted)
      : random(static_cast<unsigned>(pixels)), count(pixels), wanted(pixels) {
    for (std::byte& each : noise) {
      each = static_cast<std::byte>(random() & 255U);
    }
    places.resize(count);
    places.crosses = crosses;
    places.down = down;
    for (std::size_t i = 0; i < count; ++i) {
      place(i, random() % 4 < parted);
    }
  }

  void place(std::size_t pixel, bool is_parted) {
    PartedPixel right;
    right.pixel = static_cast<std::int32_t>(pixel);
    for (std::size_t row = 0; row < 2; ++row) {
      places.upper[row][pixel] = somewhere();
      places.lower[row][pixel] = somewhere();
      right.upper[row] = somewhere();
      right.lower[row] = places.crosses ? somewhere() : right.upper[row] + places.down;
      const std::byte* const above = places.upper[row][pixel];
      const std::byte* const below = places.below(row, pixel);
      constexpr std::size_t kTexel = kTexelLevels * sizeof(Level);
      wanted[pixel][0][row] = pair(above, is_parted ? right.upper[row] : above + kTexel);
      wanted[pixel][1][row] = pair(below, is_parted ? right.lower[row] : below + kTexel);
    }
    if (is_parted) {
      places.parted[places.parted_count++] = right;
    }
  }

  const std::byte* somewhere() { return noise.data() + random() % 10'000; }

  static std::vector<std::byte> pair(const std::byte* left, const std::byte* right) {
    constexpr std::size_t kTexel = kTexelLevels * sizeof(Level);
    std::vector<std::byte> texels(left, left + kTexel);
    texels.insert(texels.end(), right, right + kTexel);
    return texels;
  }
};

TYPED_TEST(PartedPairsTest, AreWholeOnceTheyAreJoined) {
  using Level = TypeParam;
  constexpr std::size_t kPair = 2 * kTexelLevels * sizeof(Level);
  std::size_t parted = 0;
  for (std::size_t count = 1; count < 150; ++count) {
    for (const std::ptrdiff_t down : {0, 128, 188, 2112}) {
      for (const unsigned of_four : {0U, 1U, 4U}) {
        for (const bool crosses : {false, true}) {
          NoisyRow<Level> row(count, crosses, down, of_four);
          parted += row.places.parted_count;
          PartedPairs<Level> pairs;  // whose memory is just what this row needs
          pairs.join(row.places);
          ASSERT_EQ(row.places.parted_count, 0U);
          for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t j = 0; j < 2; ++j) {
              const std::byte* const above = row.places.upper[j][i];
              const std::byte* const below = row.places.below(j, i);
              ASSERT_EQ(std::vector(above, above + kPair), row.wanted[i][0][j])
                  << i << " of " << count << ", down " << down;
              ASSERT_EQ(std::vector(below, below + kPair), row.wanted[i][1][j])
                  << i << " of " << count << ", down " << down;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(parted, 10'000U);
}

}  // namespace
}  // namespace biotomy::reconstruct
