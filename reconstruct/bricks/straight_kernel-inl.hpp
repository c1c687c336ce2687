// Included once for each vector width: see texel_kernels.cpp.
#if defined(BIOTOMY_STRAIGHT_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BIOTOMY_STRAIGHT_KERNEL_INL
#undef BIOTOMY_STRAIGHT_KERNEL_INL
#else
#define BIOTOMY_STRAIGHT_KERNEL_INL
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

#include "reconstruct/bricks/linear_kernel-inl.hpp"
#include "reconstruct/bricks/texel_blocks.hpp"
#include "reconstruct/bricks/texel_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace biotomy::reconstruct::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Levels side by side, with the arithmetic of mix_linear.
template <typename Level>
struct StraightLevels;

template <>
struct StraightLevels<std::uint8_t> {
  static constexpr std::size_t kLanes = HWY_MAX_BYTES < 32 ? 8 : 16;
  using D = hn::FixedTag<std::uint16_t, kLanes>;
  using D8 = hn::Rebind<std::uint8_t, D>;
  using V = hn::Vec<D>;

  HWY_INLINE static Parts<V> part(std::uint16_t part) { return Parts<V>(hn::Set(D(), part)); }
  HWY_INLINE static V load(const std::byte* levels) {
    return hn::ShiftLeft<kLevelShift>(
        hn::PromoteTo(D(), hn::LoadU(D8(), reinterpret_cast<const std::uint8_t*>(levels))));
  }
  HWY_INLINE static void store(V levels, std::uint8_t* out) {
    const V mixed = part(0).mixed(levels, levels);  // as along x by mix_linear, to the bit
    const auto rounded = hn::ShiftRight<kLevelShift>(hn::Add(mixed, hn::Set(D(), kHalfLevel)));
    hn::StoreU(hn::DemoteTo(D8(), hn::BitCast(hn::RebindToSigned<D>(), rounded)), D8(), out);
  }
};

template <>
struct StraightLevels<std::uint16_t> {
  static constexpr std::size_t kLanes = 4;
  using V = TexelVector;

  HWY_INLINE static TexelPart part(float part) { return TexelPart(part); }
  HWY_INLINE static V load(const std::byte* levels) { return texel_at(levels); }
  HWY_INLINE static void store(V levels, std::uint16_t* out) {
    const hn::FixedTag<std::uint16_t, kLanes> d16;
    const hn::FixedTag<std::int32_t, kLanes> d32;
    const auto rounded = hn::ConvertTo(d32, hn::Add(levels, hn::Set(FourFloats(), 0.5F)));
    hn::StoreU(hn::DemoteTo(d16, rounded), d16, out);
  }
};

/// Of a block's row four texels are mixed at once, which fill whole vectors only with 16 bits: what
/// is written too much belongs to the next pixels, or is kept back at the end.
template <typename Level>
HWY_INLINE void mix_straight(const StraightRun& run, const StraightParts<Level>& parts,
                             Level* rgb) {
  using Levels = StraightLevels<Level>;
  constexpr std::size_t kLevels = std::size_t{TexelBlocks::kSide} * TexelBlocks::kColours;
  constexpr std::size_t kRoom = (kLevels + Levels::kLanes - 1) / Levels::kLanes * Levels::kLanes;
  constexpr std::size_t kTexel = TexelBlocks::kColours * sizeof(Level);
  constexpr std::size_t kBlock = TexelBlocks::kBlockLevels * sizeof(Level);
  const auto y = Levels::part(parts.y);
  const auto z = Levels::part(parts.z);
  const auto mix_block = [&](std::size_t place, Level* out) HWY_ATTR {
    for (std::size_t i = 0; i < kLevels; i += Levels::kLanes) {
      const auto at = [&](const std::byte* row)
                          HWY_ATTR { return Levels::load(row + place + i * sizeof(Level)); };
      const auto here = z.mixed(at(run.upper[0]), at(run.lower[0]));
      const auto next = z.mixed(at(run.upper[1]), at(run.lower[1]));
      Levels::store(y.mixed(here, next), out + i);
    }
  };
  std::size_t texel = run.first;
  for (std::size_t left = run.count; left > 0;) {
    const std::size_t within = texel % TexelBlocks::kSide;
    const std::size_t count = std::min(left, TexelBlocks::kSide - within);
    const std::size_t place = texel / TexelBlocks::kSide * kBlock + within * kTexel;
    if (TexelBlocks::kColours * left >= kRoom) {
      mix_block(place, rgb);
    } else {
      Level block[kRoom];
      mix_block(place, block);
      std::memcpy(rgb, block, count * kTexel);
    }
    rgb += TexelBlocks::kColours * count;
    texel += count;
    left -= count;
  }
}

}  // namespace biotomy::reconstruct::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
