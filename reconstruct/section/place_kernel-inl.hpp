// Included once for each vector width: see texel_kernels.cpp.
#if defined(BIOTOMY_PLACE_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BIOTOMY_PLACE_KERNEL_INL
#undef BIOTOMY_PLACE_KERNEL_INL
#else
#define BIOTOMY_PLACE_KERNEL_INL
#endif

#include <algorithm>
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

/// Which brick of the box a voxel lies in, and which texel of it. `kShifts`: all sides are powers
/// of two, as they usually are; else by float, which tells such small numbers apart exactly.
template <bool kShifts>
class Bricks {
 public:
  HWY_INLINE explicit Bricks(const RowAxis& axis)
      : side_(axis.side),
        bits_(hwy::Num0BitsBelowLS1Bit_Nonzero32(static_cast<std::uint32_t>(axis.side))),
        inverse_side_(1.0F / static_cast<float>(axis.side)) {}

  HWY_INLINE PositionVector of(PositionVector voxel) const {
    const Positions d;
    if constexpr (kShifts) {
      return hn::ShiftRightSame(voxel, static_cast<int>(bits_));
    } else {
      const hn::RebindToFloat<Positions> df;
      const auto middle = hn::Add(hn::ConvertTo(df, voxel), hn::Set(df, 0.5F));
      return hn::ConvertTo(d, hn::Mul(middle, hn::Set(df, inverse_side_)));
    }
  }

  HWY_INLINE PositionVector texel(PositionVector voxel, PositionVector brick) const {
    const Positions d;
    if constexpr (kShifts) {
      return hn::And(voxel, hn::Set(d, side_ - 1));
    } else {
      return hn::Sub(voxel, hn::Mul(brick, hn::Set(d, side_)));
    }
  }

 private:
  std::int32_t side_;
  std::size_t bits_;
  float inverse_side_;
};

/// Pixels along one axis.
template <bool kShifts>
class AxisVectors {
 public:
  HWY_INLINE AxisVectors(const RowAxis& axis, PositionVector pixel) : axis_(axis), bricks_(axis) {
    const Positions d;
    const auto last = hn::Set(d, axis.last);
    position_ = hn::Add(hn::Set(d, axis.start), hn::Mul(pixel, hn::Set(d, axis.step)));
    const auto voxel = hn::Add(hn::Set(d, axis.base), hn::ShiftRight<kFractionBits>(position_));
    voxel_ = hn::Min(hn::Max(voxel, hn::Set(d, axis.first)), last);
    next_ = hn::Min(hn::Add(voxel_, hn::Set(d, axis.next)), last);
    mixes_ = hn::And(hn::Eq(voxel, voxel_), hn::Lt(voxel, last));
  }

  HWY_INLINE PositionVector brick() const { return bricks_.of(voxel_); }
  HWY_INLINE PositionVector next_brick() const { return bricks_.of(next_); }
  HWY_INLINE PositionVector slot(PositionVector brick) const {
    return hn::Mul(brick, hn::Set(Positions(), axis_.slot_stride));
  }
  HWY_INLINE PositionVector texel(PositionVector brick) const {
    return bricks_.texel(voxel_, brick);
  }
  HWY_INLINE PositionVector next_texel(PositionVector brick) const {
    return bricks_.texel(next_, brick);
  }
  /// The position, with nothing behind the point where there is nothing to mix.
  HWY_INLINE PositionVector position() const { return hn::IfThenElseZero(mixes_, position_); }

 private:
  const RowAxis& axis_;
  Bricks<kShifts> bricks_;
  PositionVector position_;
  PositionVector voxel_;
  PositionVector next_;
  hn::Mask<Positions> mixes_;
};

inline bool sides_are_powers_of_two(const RowPath& path) {
  return std::all_of(path.axes.begin(), path.axes.end(),
                     [](const RowAxis& axis) { return (axis.side & (axis.side - 1)) == 0; });
}

template <bool kShifts>
void find_bricks_by(const RowPath& path, std::size_t count, RowBricks& bricks) {
  const Positions d;
  const auto last = hn::Set(d, static_cast<std::int32_t>(count) - 1);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto pixel = hn::Min(hn::Iota(d, static_cast<std::int32_t>(i)), last);
    const AxisVectors<kShifts> x(path.axes[0], pixel);
    const AxisVectors<kShifts> y(path.axes[1], pixel);
    const AxisVectors<kShifts> z(path.axes[2], pixel);
    hn::StoreU(hn::Add(x.slot(x.brick()), hn::Add(y.slot(y.brick()), z.slot(z.brick()))), d,
               bricks.near.data() + i);
    hn::StoreU(
        hn::Add(x.slot(x.next_brick()), hn::Add(y.slot(y.next_brick()), z.slot(z.next_brick()))), d,
        bricks.far.data() + i);
  }
}

inline void find_bricks(const RowPath& path, std::size_t count, RowBricks& bricks) {
  if (sides_are_powers_of_two(path)) {
    find_bricks_by<true>(path, count, bricks);
  } else {
    find_bricks_by<false>(path, count, bricks);
  }
}

template <bool kShifts, typename Level>
void place_row_by(const RowPath& path, std::size_t count, RowTexels<Level>& texels,
                  PixelPlaces<Level>& places) {
  constexpr int kShift = sizeof(Level) == 1 ? 0 : 1;
  const Positions d;
  const auto last = hn::Set(d, static_cast<std::int32_t>(count) - 1);
  const auto block_row_bytes = hn::Set(d, path.block_row_bytes);
  const auto layer_bytes = hn::Set(d, path.layer_bytes);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    // Behind the row's end the last pixel is repeated, so that every place is one of a texel.
    const auto pixel = hn::Min(hn::Iota(d, static_cast<std::int32_t>(i)), last);
    const AxisVectors<kShifts> x(path.axes[0], pixel);
    const AxisVectors<kShifts> y(path.axes[1], pixel);
    const AxisVectors<kShifts> z(path.axes[2], pixel);
    const auto brick_x = x.brick();
    const auto slot_x = x.slot(brick_x);
    const auto offset_x = along_x<kShift>(x.texel(brick_x));
    hn::StoreU(hn::Sub(x.next_brick(), brick_x), d, texels.parted.data() + i);
    const auto store = [&](std::size_t pair, PositionVector brick_y, PositionVector texel_y,
                           PositionVector brick_z, PositionVector texel_z) HWY_ATTR {
      hn::StoreU(hn::Add(slot_x, hn::Add(y.slot(brick_y), z.slot(brick_z))), d,
                 texels.slots[pair].data() + i);
      hn::StoreU(hn::Add(offset_x, hn::Add(along_y<kShift>(texel_y, block_row_bytes),
                                           hn::Mul(texel_z, layer_bytes))),
                 d, texels.offsets[pair].data() + i);
    };
    const auto brick_y = y.brick();
    const auto next_brick_y = y.next_brick();
    const auto texel_y = y.texel(brick_y);
    const auto next_texel_y = y.next_texel(next_brick_y);
    const auto brick_z = z.brick();
    const auto texel_z = z.texel(brick_z);
    store(0, brick_y, texel_y, brick_z, texel_z);
    store(1, next_brick_y, next_texel_y, brick_z, texel_z);
    if (places.crosses) {
      const auto next_brick_z = z.next_brick();
      const auto next_texel_z = z.next_texel(next_brick_z);
      store(2, brick_y, texel_y, next_brick_z, next_texel_z);
      store(3, next_brick_y, next_texel_y, next_brick_z, next_texel_z);
    }
    store_part(x.position(), places.x.data() + i);
    store_part(y.position(), places.y.data() + i);
    store_part(z.position(), places.z.data() + i);
  }
}

template <typename Level>
void place_row(const RowPath& path, std::size_t count, RowTexels<Level>& texels,
               PixelPlaces<Level>& places) {
  if (sides_are_powers_of_two(path)) {
    place_row_by<true>(path, count, texels, places);
  } else {
    place_row_by<false>(path, count, texels, places);
  }
}

}  // namespace biotomy::reconstruct::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
