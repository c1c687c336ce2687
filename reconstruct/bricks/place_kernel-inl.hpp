// Included once for each vector width: see texel_kernels.cpp.
#if defined(BIOTOMY_PLACE_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BIOTOMY_PLACE_KERNEL_INL
#undef BIOTOMY_PLACE_KERNEL_INL
#else
#define BIOTOMY_PLACE_KERNEL_INL
#endif

#include <cstddef>
#include <cstdint>
#include <span>

#include <hwy/highway.h>

#include "reconstruct/bricks/texel_blocks.hpp"
#include "reconstruct/bricks/texel_kernels.hpp"

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

/// A row's positions along one axis.
class AxisVectors {
 public:
  HWY_INLINE explicit AxisVectors(const RowAxis& axis)
      : axis_(axis),
        positions_(hn::Add(hn::Set(Positions(), axis.start),
                           hn::Mul(hn::Iota(Positions(), 0), hn::Set(Positions(), axis.step)))) {}

  /// Of pixel `first` and those behind it.
  HWY_INLINE PositionVector position(std::int32_t first) const {
    return hn::Add(positions_, hn::Set(Positions(), first * axis_.step));
  }
  /// The texel of its brick that the voxel at a position is.
  HWY_INLINE PositionVector near(PositionVector position, const BrickPair& bricks) const {
    return texel(position, axis_.base - bricks.near * axis_.side);
  }
  /// Likewise the next voxel, of its own.
  HWY_INLINE PositionVector far(PositionVector position, const BrickPair& bricks) const {
    return texel(position, axis_.base + axis_.next - bricks.far * axis_.side);
  }

 private:
  HWY_INLINE static PositionVector texel(PositionVector position, int origin) {
    return hn::Add(hn::ShiftRight<kFractionBits>(position), hn::Set(Positions(), origin));
  }

  const RowAxis& axis_;
  PositionVector positions_;
};

HWY_INLINE void store_places(const std::byte* brick, PositionVector offsets,
                             const std::byte** out) {
  static_assert(sizeof *out == sizeof(std::int64_t), "vectors hold places in memory as 64 bits");
  const hn::Half<Positions> half;
  const hn::Repartition<std::int64_t, Positions> d64;
  const auto base = hn::Set(d64, reinterpret_cast<std::int64_t>(brick));
  auto* const places = reinterpret_cast<std::int64_t*>(out);
  hn::StoreU(hn::Add(base, hn::PromoteTo(d64, hn::LowerHalf(half, offsets))), d64, places);
  hn::StoreU(hn::Add(base, hn::PromoteTo(d64, hn::UpperHalf(half, offsets))), d64,
             places + hn::Lanes(d64));
}

template <bool kCrosses, typename Level>
HWY_INLINE void place_runs_by(const RowPath& path, std::span<const BrickRun> runs,
                              const std::byte* const* bricks, PixelPlaces<Level>& places) {
  constexpr int kShift = sizeof(Level) == 1 ? 0 : 1;
  const Positions d;
  const AxisVectors x_axis(path.axes[0]);
  const AxisVectors y_axis(path.axes[1]);
  const AxisVectors z_axis(path.axes[2]);
  const auto block_row_bytes = hn::Set(d, path.block_row_bytes);
  const auto layer_bytes = hn::Set(d, path.layer_bytes);
  for (const BrickRun& run : runs) {
    if (run.parted) {
      continue;
    }
    const BrickPair& x_bricks = run.bricks[0];
    const BrickPair& y_bricks = run.bricks[1];
    const BrickPair& z_bricks = run.bricks[2];
    const auto brick = [&](int along_y, int along_z) {
      return bricks[path.slot(x_bricks.near, along_y, along_z)];
    };
    const std::byte* const here = brick(y_bricks.near, z_bricks.near);
    const std::byte* const next = brick(y_bricks.far, z_bricks.near);
    for (int i = run.first; i < run.last; i += static_cast<int>(hn::Lanes(d))) {
      const auto x = x_axis.position(i);
      const auto y = y_axis.position(i);
      const auto z = z_axis.position(i);
      const auto texel = along_x<kShift>(x_axis.near(x, x_bricks));
      const auto row = hn::Add(texel, along_y<kShift>(y_axis.near(y, y_bricks), block_row_bytes));
      const auto next_row =
          hn::Add(texel, along_y<kShift>(y_axis.far(y, y_bricks), block_row_bytes));
      const auto layer = hn::Mul(z_axis.near(z, z_bricks), layer_bytes);
      store_places(here, hn::Add(row, layer), places.upper[0].data() + i);
      store_places(next, hn::Add(next_row, layer), places.upper[1].data() + i);
      if constexpr (kCrosses) {
        const auto next_layer = hn::Mul(z_axis.far(z, z_bricks), layer_bytes);
        store_places(brick(y_bricks.near, z_bricks.far), hn::Add(row, next_layer),
                     places.lower[0].data() + i);
        store_places(brick(y_bricks.far, z_bricks.far), hn::Add(next_row, next_layer),
                     places.lower[1].data() + i);
      }
      store_part(x, places.x.data() + i);
      store_part(y, places.y.data() + i);
      store_part(z, places.z.data() + i);
    }
  }
}

template <typename Level>
void place_runs(const RowPath& path, std::span<const BrickRun> runs, const std::byte* const* bricks,
                PixelPlaces<Level>& places) {
  if (places.crosses) {
    place_runs_by<true>(path, runs, bricks, places);
  } else {
    place_runs_by<false>(path, runs, bricks, places);
  }
}

}  // namespace biotomy::reconstruct::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
