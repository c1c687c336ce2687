// Included once for each vector width: see texel_kernels.cpp.
#if defined(BIOTOMY_FIND_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BIOTOMY_FIND_KERNEL_INL
#undef BIOTOMY_FIND_KERNEL_INL
#else
#define BIOTOMY_FIND_KERNEL_INL
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "reconstruct/bricks/axis_vectors-inl.hpp"
#include "reconstruct/bricks/row_path.hpp"
#include "reconstruct/bricks/texel_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace biotomy::reconstruct::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// What an axis contributes to the number of SupportBricks.
HWY_INLINE PositionVector brick_number(const AxisPlaces& places, unsigned axis) {
  const Positions d;
  const auto further = hn::IfThenElseZero(places.parted, hn::Set(d, 1 << axis));
  return hn::Or(hn::ShiftLeft<static_cast<int>(SupportBricks::kAxisBits)>(places.near_slot),
                further);
}

template <bool kBorder, bool kInALayer>
HWY_INLINE std::size_t find_bricks_by(const RowPath& path, int count, std::int32_t* found) {
  const Positions d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const AxisVectors<kBorder> x_axis(path.axes[0]);
  const AxisVectors<kBorder> y_axis(path.axes[1]);
  const AxisVectors<kBorder> z_axis(path.axes[2]);
  const AxisPositions x(path.axes[0], count);
  const AxisPositions y(path.axes[1], count);
  const AxisPositions z(path.axes[2], count);
  const auto along_z = brick_number(z_axis.at(z.from(0)), 2);
  // Behind a number that no pixel has: all pixels' own.
  HWY_ALIGN std::int32_t numbers[1 + kMostPixels + kRoomPixels];
  numbers[0] = -1;
  for (int i = 0; i < count; i += lanes) {
    const auto in_layer =
        hn::Add(brick_number(x_axis.at(x.from(i)), 0), brick_number(y_axis.at(y.from(i)), 1));
    const auto number =
        hn::Add(in_layer, kInALayer ? along_z : brick_number(z_axis.at(z.from(i)), 2));
    hn::StoreU(number, d, numbers + 1 + i);
  }
  std::size_t total = 0;
  for (int i = 0; i < count; i += lanes) {
    const auto number = hn::LoadU(d, numbers + 1 + i);
    const auto changes = hn::Ne(number, hn::LoadU(d, numbers + i));
    hn::StoreU(hn::Compress(number, changes), d, found + total);
    total += hn::CountTrue(d, changes);
  }
  return total;
}

inline std::size_t find_bricks(const RowPath& path, int count, std::int32_t* found) {
  const bool inside = path.is_inside(count);
  if (path.stays_in_a_layer()) {
    return inside ? find_bricks_by<false, true>(path, count, found)
                  : find_bricks_by<true, true>(path, count, found);
  }
  return inside ? find_bricks_by<false, false>(path, count, found)
                : find_bricks_by<true, false>(path, count, found);
}

}  // namespace biotomy::reconstruct::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
