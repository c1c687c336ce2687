// Included once for each vector width: see texel_kernels.cpp.
#if defined(BIOTOMY_LINEAR_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BIOTOMY_LINEAR_KERNEL_INL
#undef BIOTOMY_LINEAR_KERNEL_INL
#else
#define BIOTOMY_LINEAR_KERNEL_INL
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "reconstruct/bricks/texel_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace biotomy::reconstruct::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// ---- 8 bits. A vector is made of blocks of 128 bits; a block holds one pixel's pair of texels,
// six levels of 16 bits and two that mean nothing. Two vectors make one of results, which holds two
// pixels a block: `even` is of pixels 0, 2, 4 … and `odd` of pixels 1, 3, 5 ….

constexpr std::size_t kBlocks = (HWY_MAX_BYTES < 64 ? HWY_MAX_BYTES : 64) / 16;
using Levels16 = hn::FixedTag<std::int16_t, 8 * kBlocks>;
using LevelVector = hn::Vec<Levels16>;
constexpr std::size_t kPixelsAtOnce = 2 * kBlocks;
constexpr int kLevelShift = 7;  // bits below a level: differences of levels just fit into 16 bits

/// The pairs at pair[0] + offset, pair[2] + offset … of a vector's blocks: eight bytes each, since
/// longer loads would reach into the next line of memory, which nobody has asked for.
template <std::size_t blocks>
HWY_INLINE auto load_pairs(const std::byte* const* pair, std::ptrdiff_t offset) {
  const hn::FixedTag<std::uint64_t, blocks> d;
  if constexpr (blocks == 1) {
    return hn::LoadU(d, reinterpret_cast<const std::uint64_t*>(pair[0] + offset));
  } else {
    return hn::Combine(d, load_pairs<blocks / 2>(pair + blocks, offset),
                       load_pairs<blocks / 2>(pair, offset));
  }
}

HWY_INLINE LevelVector levels_at(const std::byte* const* pair, std::ptrdiff_t offset) {
  const Levels16 d;
  const hn::Rebind<std::uint8_t, Levels16> d8;
  const auto bytes = hn::BitCast(d8, load_pairs<kBlocks>(pair, offset));
  return hn::ShiftLeft<kLevelShift>(hn::PromoteTo(d, bytes));
}

template <typename Vector>
HWY_INLINE Vector mixed(Vector a, Vector b, Vector part) {
  return hn::Add(a, hn::MulFixedPoint15(hn::Sub(b, a), part));
}

/// Byte numbers for a shuffle within each block.
struct Shuffle {
  HWY_ALIGN std::uint8_t bytes[16 * kBlocks];

  HWY_INLINE LevelVector of(LevelVector vector) const {
    const hn::Repartition<std::uint8_t, Levels16> d8;
    return hn::BitCast(Levels16(),
                       hn::TableLookupBytes(hn::BitCast(d8, vector), hn::Load(d8, bytes)));
  }
};

/// Spreads parts of pixels, two bytes each: the first half of block b takes that of pixel 2b +
/// `first`, the second that of 2b + `second`.
constexpr Shuffle spread(std::size_t first, std::size_t second) {
  Shuffle shuffle{};
  for (std::size_t i = 0; i < 16 * kBlocks; ++i) {
    const std::size_t pixel = 2 * (i / 16) + (i % 16 < 8 ? first : second);
    shuffle.bytes[i] = static_cast<std::uint8_t>(2 * pixel + i % 2);
  }
  return shuffle;
}

/// Makes two texels of three levels two of four: the last level of each means nothing.
constexpr Shuffle widen() {
  Shuffle shuffle{};
  for (std::size_t i = 0; i < 16 * kBlocks; ++i) {
    const std::size_t level = i % 16 / 2;
    shuffle.bytes[i] = static_cast<std::uint8_t>(2 * (level < 4 ? level : level - 1) + i % 2);
  }
  return shuffle;
}

constexpr Shuffle kToEven = spread(0, 0);
constexpr Shuffle kToOdd = spread(1, 1);
constexpr Shuffle kToBoth = spread(0, 1);
constexpr Shuffle kWiden = widen();

/// Pixels `at` + odd, at + odd + 2 … mixed along z and y.
template <bool kCrosses>
HWY_INLINE LevelVector mixed_pairs(const PixelPlaces<std::uint8_t>& places, std::size_t at,
                                   std::size_t odd) {
  const Levels16 d;
  const Shuffle& to_pixels = odd == 0 ? kToEven : kToOdd;
  const auto part_y = to_pixels.of(hn::LoadDup128(d, places.y.data() + at));
  const auto part_z = to_pixels.of(hn::LoadDup128(d, places.z.data() + at));
  const auto& below = kCrosses ? places.lower : places.upper;
  const std::ptrdiff_t down = kCrosses ? 0 : places.down;
  const std::size_t first = at + odd;
  const auto here = mixed(levels_at(places.upper[0].data() + first, 0),
                          levels_at(below[0].data() + first, down), part_z);
  const auto next = mixed(levels_at(places.upper[1].data() + first, 0),
                          levels_at(below[1].data() + first, down), part_z);
  return kWiden.of(mixed(here, next, part_y));
}

template <bool kCrosses>
HWY_INLINE void mix_row(const PixelPlaces<std::uint8_t>& places, std::size_t count,
                        std::uint8_t* pixels) {
  const Levels16 d;
  const hn::Repartition<std::uint64_t, Levels16> d64;
  const hn::Rebind<std::uint8_t, Levels16> d8;
  for (std::size_t at = 0; at < count; at += kPixelsAtOnce) {
    const auto even = hn::BitCast(d64, mixed_pairs<kCrosses>(places, at, 0));
    const auto odd = hn::BitCast(d64, mixed_pairs<kCrosses>(places, at, 1));
    const auto left = hn::BitCast(d, hn::InterleaveLower(d64, even, odd));
    const auto right = hn::BitCast(d, hn::InterleaveUpper(d64, even, odd));
    const auto sum = mixed(left, right, kToBoth.of(hn::LoadDup128(d, places.x.data() + at)));
    const auto rounded =
        hn::ShiftRight<kLevelShift>(hn::Add(sum, hn::Set(d, 1 << (kLevelShift - 1))));
    hn::StoreU(hn::DemoteTo(d8, rounded), d8, pixels + 4 * at);
  }
}

inline void mix_linear(const PixelPlaces<std::uint8_t>& places, std::size_t count,
                       std::uint8_t* pixels) {
  if (places.crosses) {
    mix_row<true>(places, count, pixels);
  } else {
    mix_row<false>(places, count, pixels);
  }
}

// ---- 16 bits: a texel is a vector of four floats.

using FourFloats = hn::FixedTag<float, 4>;
using TexelVector = hn::Vec<FourFloats>;

HWY_INLINE TexelVector texel_at(const std::byte* texel) {
  const hn::FixedTag<std::uint16_t, 4> d16;
  const hn::FixedTag<std::int32_t, 4> d32;
  const auto levels = hn::LoadU(d16, reinterpret_cast<const std::uint16_t*>(texel));
  return hn::ConvertTo(FourFloats(), hn::PromoteTo(d32, levels));
}

HWY_INLINE TexelVector mixed(TexelVector a, TexelVector b, float part) {
  return hn::MulAdd(hn::Sub(b, a), hn::Set(FourFloats(), part), a);
}

inline void mix_linear(const PixelPlaces<std::uint16_t>& places, std::size_t count,
                       std::uint16_t* pixels) {
  constexpr std::ptrdiff_t kRight = 6;  // bytes to the right texel of a pair
  const hn::FixedTag<std::uint16_t, 4> d16;
  const hn::FixedTag<std::int32_t, 4> d32;
  for (std::size_t i = 0; i < count; ++i) {
    const auto along_z = [&](std::size_t row, std::ptrdiff_t to) HWY_ATTR {
      const std::byte* upper = places.upper[row][i];
      const std::byte* lower = places.crosses ? places.lower[row][i] : upper + places.down;
      return mixed(texel_at(upper + to), texel_at(lower + to), places.z[i]);
    };
    const auto left = mixed(along_z(0, 0), along_z(1, 0), places.y[i]);
    const auto right = mixed(along_z(0, kRight), along_z(1, kRight), places.y[i]);
    const auto sum = hn::Add(mixed(left, right, places.x[i]), hn::Set(FourFloats(), 0.5F));
    hn::StoreU(hn::DemoteTo(d16, hn::ConvertTo(d32, sum)), d16, pixels + 4 * i);
  }
}

}  // namespace biotomy::reconstruct::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
