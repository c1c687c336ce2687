// Included once for each vector width: see texel_kernels.cpp.
#if defined(BIOTOMY_LINEAR_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BIOTOMY_LINEAR_KERNEL_INL
#undef BIOTOMY_LINEAR_KERNEL_INL
#else
#define BIOTOMY_LINEAR_KERNEL_INL
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

#include "reconstruct/bricks/texel_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace biotomy::reconstruct::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// ---- 8 bits. A vector is made of blocks of 128 bits; a block holds the pairs of texels of two
// pixels, and when its levels have been widened to 16 bits one pixel's: six levels and two that
// mean nothing. `even` is of pixels 0, 2, 4 … and `odd` of pixels 1, 3, 5 ….

constexpr std::size_t kBlocks = (HWY_MAX_BYTES < 64 ? HWY_MAX_BYTES : 64) / 16;
using Levels16 = hn::FixedTag<std::uint16_t, 8 * kBlocks>;
using LevelVector = hn::Vec<Levels16>;
constexpr std::size_t kPixelsAtOnce = 2 * kBlocks;
constexpr int kLevelShift = 8;  // bits below a level

/// Pairs of texels in a layer, and those at the same places in the next.
template <typename Vector>
struct TwoLayers {
  Vector upper;
  Vector lower;
};

/// Those of pixels 0, 1, 2 …: eight bytes each, since longer loads would reach into the next line
/// of memory, which nobody has asked for.
template <std::size_t pairs>
HWY_INLINE auto load_pairs(const std::byte* const* upper, const std::byte* const* lower,
                           std::ptrdiff_t down) {
  const hn::FixedTag<std::uint64_t, pairs> d;
  using Loaded = TwoLayers<hn::Vec<decltype(d)>>;
  if constexpr (pairs == 1) {
    return Loaded{hn::LoadU(d, reinterpret_cast<const std::uint64_t*>(upper[0])),
                  hn::LoadU(d, reinterpret_cast<const std::uint64_t*>(lower[0] + down))};
  } else {
    const auto first = load_pairs<pairs / 2>(upper, lower, down);
    const auto second = load_pairs<pairs / 2>(upper + pairs / 2, lower + pairs / 2, down);
    return Loaded{hn::Combine(d, second.upper, first.upper),
                  hn::Combine(d, second.lower, first.lower)};
  }
}

/// Levels of the pairs of even and odd pixels.
struct EvenOdd {
  LevelVector even;
  LevelVector odd;
};

template <typename Pairs>
HWY_INLINE EvenOdd levels_of(Pairs pairs) {
  const Levels16 d;
  const hn::Repartition<std::uint8_t, Levels16> d8;
  const auto bytes = hn::BitCast(d8, pairs);
  return {hn::BitCast(d, hn::InterleaveLower(d8, hn::Zero(d8), bytes)),
          hn::BitCast(d, hn::InterleaveUpper(d8, hn::Zero(d8), bytes))};
}

/// How much of what two colours are mixed of is the second's, and the first's, in 2⁻¹⁶.
template <typename Vector>
struct Parts {
  Vector second;
  Vector first;

  HWY_INLINE explicit Parts(Vector part) : second(part), first(hn::Not(part)) {}

  HWY_INLINE Vector mixed(Vector a, Vector b) const {
    return hn::Add(hn::MulHigh(a, first), hn::MulHigh(b, second));
  }
};
using LevelParts = Parts<LevelVector>;

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

constexpr Shuffle kToEven = spread(0, 0);
constexpr Shuffle kToOdd = spread(1, 1);
constexpr Shuffle kToBoth = spread(0, 1);

constexpr std::size_t kStoredTooMuch = 4;  // levels behind the last pixel's

/// R G B of pixels of four levels. Writes kStoredTooMuch levels more.
template <typename D>
HWY_INLINE void store_packed(hn::Vec<D> pixels, D d, std::uint8_t* rgb) {
  constexpr std::size_t kBytes = hn::MaxLanes(d);
  if constexpr (kBytes > 16) {
    const hn::Half<D> half;
    store_packed(hn::LowerHalf(half, pixels), half, rgb);
    store_packed(hn::UpperHalf(half, pixels), half, rgb + kBytes / 2 / 4 * 3);
  } else {
    HWY_ALIGN static constexpr std::uint8_t kPacked[16] = {0,  1,  2,  4,  5,    6,    8,    9,
                                                           10, 12, 13, 14, 0x80, 0x80, 0x80, 0x80};
    hn::StoreU(hn::TableLookupBytes(pixels, hn::Load(d, kPacked)), d, rgb);
  }
}

/// The right texel's levels to where the left one's were.
HWY_INLINE LevelVector right_texel(LevelVector pair) {
  const hn::Repartition<std::uint8_t, Levels16> d8;
  return hn::BitCast(Levels16(), hn::ShiftRightBytes<6>(d8, hn::BitCast(d8, pair)));
}

template <bool kCrosses, bool kInALayer>
HWY_INLINE void mix_row(const PixelPlaces<std::uint8_t>& places, std::size_t count,
                        const PairLines<std::uint8_t>& ahead, std::uint8_t* rgb) {
  using Places = const std::byte* const*;
  const Levels16 d;
  const hn::RebindToSigned<Levels16> signed16;
  const hn::Repartition<std::uint64_t, Levels16> d64;
  const hn::Rebind<std::uint8_t, Levels16> d8;
  const Places upper[2] = {places.upper[0].data(), places.upper[1].data()};
  const Places lower[2] = {kCrosses ? places.lower[0].data() : upper[0],
                           kCrosses ? places.lower[1].data() : upper[1]};
  const std::ptrdiff_t down = kCrosses ? 0 : places.down;
  const std::uint16_t* const parts_x = places.x.data();
  const std::uint16_t* const parts_y = places.y.data();
  const std::uint16_t* const parts_z = places.z.data();
  const auto both = [&](LevelVector even, LevelVector odd) HWY_ATTR {
    return hn::BitCast(d, hn::InterleaveLower(d64, hn::BitCast(d64, even), hn::BitCast(d64, odd)));
  };
  const LevelParts same_z(hn::Set(d, parts_z[0]));
  constexpr std::size_t kLevels = 3 * kPixelsAtOnce;
  std::uint8_t kept_back[kLevels + kStoredTooMuch];
  for (std::size_t at = 0; at < count; at += kPixelsAtOnce) {
    ahead.ask(at, at + kPixelsAtOnce);
    const std::size_t levels_left = 3 * (count - at);
    const bool fits = levels_left >= kLevels + kStoredTooMuch;
    const auto part_y = hn::LoadDup128(d, parts_y + at);
    const auto part_z = hn::LoadDup128(d, parts_z + at);
    const LevelParts z_even = kInALayer ? same_z : LevelParts(kToEven.of(part_z));
    const LevelParts z_odd = kInALayer ? same_z : LevelParts(kToOdd.of(part_z));
    const auto along_z = [&](std::size_t row) HWY_ATTR {
      const auto pairs = load_pairs<kPixelsAtOnce>(upper[row] + at, lower[row] + at, down);
      const EvenOdd above = levels_of(pairs.upper);
      const EvenOdd below = levels_of(pairs.lower);
      return EvenOdd{z_even.mixed(above.even, below.even), z_odd.mixed(above.odd, below.odd)};
    };
    const EvenOdd here = along_z(0);
    const EvenOdd next = along_z(1);
    const auto even = LevelParts(kToEven.of(part_y)).mixed(here.even, next.even);
    const auto odd = LevelParts(kToOdd.of(part_y)).mixed(here.odd, next.odd);
    const LevelParts x(kToBoth.of(hn::LoadDup128(d, parts_x + at)));
    const auto sum = x.mixed(both(even, odd), both(right_texel(even), right_texel(odd)));
    const auto rounded = hn::ShiftRight<kLevelShift>(hn::Add(sum, hn::Set(d, kHalfLevel)));
    store_packed(hn::DemoteTo(d8, hn::BitCast(signed16, rounded)), d8,
                 fits ? rgb + 3 * at : kept_back);
    if (!fits) {
      std::memcpy(rgb + 3 * at, kept_back, std::min(levels_left, kLevels));
    }
  }
}

inline void mix_linear(const PixelPlaces<std::uint8_t>& places, std::size_t count,
                       const PairLines<std::uint8_t>& ahead, std::uint8_t* rgb) {
  if (!places.in_a_layer) {
    mix_row<true, false>(places, count, ahead, rgb);
  } else if (places.crosses) {
    mix_row<true, true>(places, count, ahead, rgb);
  } else {
    mix_row<false, true>(places, count, ahead, rgb);
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

/// How much of what two texels are mixed of is the second.
struct TexelPart {
  TexelVector second;

  HWY_INLINE explicit TexelPart(float part) : second(hn::Set(FourFloats(), part)) {}

  HWY_INLINE TexelVector mixed(TexelVector a, TexelVector b) const {
    return hn::MulAdd(hn::Sub(b, a), second, a);
  }
};

inline void mix_linear(const PixelPlaces<std::uint16_t>& places, std::size_t count,
                       const PairLines<std::uint16_t>& ahead, std::uint16_t* rgb) {
  constexpr std::ptrdiff_t kRight = 6;  // bytes to the right texel of a pair
  const hn::FixedTag<std::uint16_t, 4> d16;
  const hn::FixedTag<std::int32_t, 4> d32;
  for (std::size_t i = 0; i < count; ++i) {
    ahead.ask(i, i + 1);
    const TexelPart x(places.x[i]);
    const TexelPart y(places.y[i]);
    const TexelPart z(places.z[places.in_a_layer ? 0 : i]);
    const auto along_z = [&](std::size_t row, std::ptrdiff_t to) HWY_ATTR {
      return z.mixed(texel_at(places.upper[row][i] + to), texel_at(places.below(row, i) + to));
    };
    const auto left = y.mixed(along_z(0, 0), along_z(1, 0));
    const auto right = y.mixed(along_z(0, kRight), along_z(1, kRight));
    const auto sum = hn::Add(x.mixed(left, right), hn::Set(FourFloats(), 0.5F));
    const auto levels = hn::DemoteTo(d16, hn::ConvertTo(d32, sum));
    if (i + 1 < count) {
      hn::StoreU(levels, d16, rgb + 3 * i);  // the fourth one belongs to the next pixel
    } else {
      std::uint16_t last[4];
      hn::StoreU(levels, d16, last);
      std::memcpy(rgb + 3 * i, last, 3 * sizeof *last);
    }
  }
}

}  // namespace biotomy::reconstruct::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
