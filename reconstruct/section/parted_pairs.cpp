#include "reconstruct/section/parted_pairs.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "reconstruct/bricks/texel_blocks.hpp"

namespace biotomy::reconstruct {
namespace {

/// One level more than a texel's is copied, to have whole words.
template <typename Level>
void copy_pair(const std::byte* left, const std::byte* right, std::byte* pair) {
  constexpr std::size_t kTexel = TexelBlocks::kColours * sizeof(Level);
  std::memcpy(pair, left, kTexel + sizeof(Level));
  std::memcpy(pair + kTexel, right, kTexel + sizeof(Level));
}

}  // namespace

// Pairs in the next layer have to lie as far behind the others as `places` says. Where that is not
// far enough for those of all pixels, groups of the ones and of the others lie in turn.
template <typename Level>
void PartedPairs<Level>::join(PixelPlaces<Level>& places) {
  constexpr std::size_t kPair = 8 * sizeof(Level);  // two texels, and two levels of no use
  constexpr std::size_t kPixel = 2 * kPair;         // in a row and in the next
  const std::size_t count = places.parted_count;
  if (count == 0) {
    return;
  }
  const bool in_groups = !places.crosses && places.down > 0;
  const std::size_t down = places.crosses ? kPixel * count : static_cast<std::size_t>(places.down);
  // A layer has at least two blocks, room for several pixels.
  const std::size_t of_group = in_groups ? std::max(down / kPixel, std::size_t{1}) : count;
  const std::size_t full_groups = (count - 1) / of_group;
  const std::size_t bytes =
      full_groups * 2 * down + down + (count - full_groups * of_group) * kPixel;
  if (texels_.size() < bytes) {
    texels_.resize(bytes);
  }
  std::byte* upper = texels_.data();
  std::size_t left = of_group;
  for (std::size_t i = 0; i < count; ++i) {
    if (left == 0) {
      upper += 2 * down - of_group * kPixel;
      left = of_group;
    }
    --left;
    const PartedPixel& right = places.parted[i];
    const auto pixel = static_cast<std::size_t>(right.pixel);
    for (std::size_t row = 0; row < 2; ++row) {
      std::byte* const lower = upper + down;
      copy_pair<Level>(places.below(row, pixel), right.lower[row], lower);
      copy_pair<Level>(places.upper[row][pixel], right.upper[row], upper);
      places.upper[row][pixel] = upper;
      if (places.crosses) {
        places.lower[row][pixel] = lower;
      }
      upper += kPair;
    }
  }
  places.parted_count = 0;
}

template class PartedPairs<std::uint8_t>;
template class PartedPairs<std::uint16_t>;

}  // namespace biotomy::reconstruct
