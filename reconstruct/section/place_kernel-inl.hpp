// Included once for each vector width: see texel_kernels.cpp.
#if defined(BIOTOMY_PLACE_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BIOTOMY_PLACE_KERNEL_INL
#undef BIOTOMY_PLACE_KERNEL_INL
#else
#define BIOTOMY_PLACE_KERNEL_INL
#endif

#include <cstdint>

#include <hwy/highway.h>

#include "reconstruct/section/texel_blocks.hpp"
#include "reconstruct/section/texel_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace biotomy::reconstruct::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Positions = hn::CappedTag<std::int32_t, kRoomPixels>;
using PositionVector = hn::Vec<Positions>;

HWY_INLINE void store_part(PositionVector position, std::int16_t* out) {
  constexpr int kPartBits = 15;
  const Positions d;
  const hn::Rebind<std::int16_t, Positions> d16;
  const auto part = hn::And(hn::ShiftRight<kFractionBits - kPartBits>(position),
                            hn::Set(d, (1 << kPartBits) - 1));
  hn::StoreU(hn::DemoteTo(d16, part), d16, out);
}

HWY_INLINE void store_part(PositionVector position, float* out) {
  constexpr float kUnit = 1.0F / static_cast<float>(1 << kFractionBits);
  const Positions d;
  const hn::RebindToFloat<Positions> df;
  const auto part = hn::And(position, hn::Set(d, (1 << kFractionBits) - 1));
  hn::StoreU(hn::Mul(hn::ConvertTo(df, part), hn::Set(df, kUnit)), df, out);
}

/// base + offset for each lane.
HWY_INLINE void store_addresses(const std::byte* base, PositionVector offset,
                                const std::byte** out) {
  const hn::Half<Positions> half;
  const hn::Repartition<std::int64_t, Positions> wide;
  const auto start =
      hn::Set(wide, static_cast<std::int64_t>(reinterpret_cast<std::intptr_t>(base)));
  auto* addresses = reinterpret_cast<std::int64_t*>(out);
  hn::StoreU(hn::Add(start, hn::PromoteTo(wide, hn::LowerHalf(half, offset))), wide, addresses);
  hn::StoreU(hn::Add(start, hn::PromoteTo(wide, hn::UpperHalf(half, offset))), wide,
             addresses + hn::Lanes(wide));
}

constexpr int kSideBits = 2;
static_assert(TexelBlocks::kSide == 1 << kSideBits);

/// A coordinate within its block.
HWY_INLINE PositionVector within_block(PositionVector coordinate) {
  return hn::And(coordinate, hn::Set(Positions(), TexelBlocks::kSide - 1));
}

/// What a texel's x contributes to its place: blocks of 64 levels, in them texels of 3.
template <int level_shift>
HWY_INLINE PositionVector along_x(PositionVector x) {
  const auto texel = within_block(x);
  const auto levels = hn::Add(hn::ShiftLeft<6>(hn::ShiftRight<kSideBits>(x)),
                              hn::Add(texel, hn::ShiftLeft<1>(texel)));
  return hn::ShiftLeft<level_shift>(levels);
}

/// What its y contributes: in blocks rows of 5 texels of 3 levels.
template <int level_shift>
HWY_INLINE PositionVector along_y(PositionVector y, PositionVector block_row_bytes) {
  const auto row = within_block(y);
  return hn::Add(hn::Mul(hn::ShiftRight<kSideBits>(y), block_row_bytes),
                 hn::ShiftLeft<level_shift>(hn::Sub(hn::ShiftLeft<4>(row), row)));
}

template <typename Level>
void place_run(const TexelRun& run, PixelPlaces<Level>& places, std::size_t first) {
  constexpr int kLevelShift = sizeof(Level) == 1 ? 0 : 1;
  const Positions d;
  const auto last = hn::Set(d, run.count - 1);
  const auto block_row_bytes = hn::Set(d, run.block_row_bytes);
  const auto layer_bytes = hn::Set(d, run.layer_bytes);
  const auto next_row = hn::Set(d, run.next_row);
  for (int i = 0; i < run.count; i += static_cast<int>(hn::Lanes(d))) {
    // Behind the run's end the last pixel is repeated, so that every address is one of a texel.
    const auto pixel = hn::Min(hn::Iota(d, i), last);
    const auto position = [&](std::size_t axis) HWY_ATTR {
      return hn::Add(hn::Set(d, static_cast<std::int32_t>(run.start[axis])),
                     hn::Mul(pixel, hn::Set(d, run.step[axis])));
    };
    const auto x = position(0);
    const auto y = position(1);
    const auto z = position(2);
    const auto offset = hn::Add(along_x<kLevelShift>(hn::ShiftRight<kFractionBits>(x)),
                                hn::Mul(hn::ShiftRight<kFractionBits>(z), layer_bytes));
    const auto row = hn::ShiftRight<kFractionBits>(y);
    const auto here = hn::Add(offset, along_y<kLevelShift>(row, block_row_bytes));
    const auto next =
        hn::Add(offset, along_y<kLevelShift>(hn::Add(row, next_row), block_row_bytes));
    const std::size_t at = first + static_cast<std::size_t>(i);
    store_addresses(run.upper, here, places.upper[0].data() + at);
    store_addresses(run.upper, next, places.upper[1].data() + at);
    if (places.crosses) {
      store_addresses(run.lower, here, places.lower[0].data() + at);
      store_addresses(run.lower, next, places.lower[1].data() + at);
    }
    store_part(x, places.x.data() + at);
    store_part(y, places.y.data() + at);
    store_part(z, places.z.data() + at);
  }
}

}  // namespace biotomy::reconstruct::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
