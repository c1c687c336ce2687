// Included once for each vector width: see texel_kernels.cpp.
#if defined(BIOTOMY_AXIS_VECTORS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BIOTOMY_AXIS_VECTORS_INL
#undef BIOTOMY_AXIS_VECTORS_INL
#else
#define BIOTOMY_AXIS_VECTORS_INL
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "reconstruct/bricks/row_path.hpp"
#include "reconstruct/bricks/texel_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace biotomy::reconstruct::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Positions = hn::CappedTag<std::int32_t, kRoomPixels>;
using PositionVector = hn::Vec<Positions>;
using PositionMask = hn::Mask<Positions>;

/// Where a vector's pixels lie along one axis: what AxisPlace says of each. (Made whole, as other
/// structs of vectors: the constructor without arguments that GCC would add is, on ARM, not for the
/// processor that the kernel is for.)
struct AxisPlaces {
  PositionVector near_slot;
  PositionVector far_slot;
  PositionVector near;
  PositionVector far;
  PositionVector part;  ///< in fixed point, maybe with whole voxels
  PositionMask parted;  ///< far_slot is that of the next brick
};

/// A row's pixels along one axis, vector by vector. Unless `kBorder`, all of them lie inside, as
/// RowAxis says it.
template <bool kBorder>
class AxisVectors {
 public:
  HWY_INLINE explicit AxisVectors(const RowAxis& axis)
      : base_(hn::Set(Positions(), axis.base)),
        next_(hn::Set(Positions(), axis.next)),
        side_(hn::Set(Positions(), axis.side)),
        stride_(hn::Set(Positions(), axis.slot_stride)),
        first_(hn::Set(Positions(), axis.first)),
        last_(hn::Set(Positions(), axis.last)),
        reciprocal_bits_(axis.side < kLongSide ? kBitsOfShortSides : kBitsOfLongSides),
        reciprocal_(hn::Set(Positions(), ((1 << reciprocal_bits_) + axis.side - 1) / axis.side)) {}

  HWY_INLINE AxisPlaces at(PositionVector position) const {
    auto voxel = hn::Add(hn::ShiftRight<kFractionBits>(position), base_);
    auto next = next_;
    auto part = position;
    if constexpr (kBorder) {
      const auto inside = hn::Min(hn::Max(voxel, first_), last_);
      const auto mixes = hn::And(hn::Eq(voxel, inside), hn::Lt(voxel, last_));
      next = hn::IfThenElseZero(mixes, next);
      part = hn::IfThenElseZero(mixes, position);
      voxel = inside;
    }
    const auto brick = brick_of(voxel);
    const auto near = hn::Sub(voxel, hn::Mul(brick, side_));
    const auto near_slot = hn::Mul(brick, stride_);
    const auto far = hn::Add(near, next);
    const auto parted = hn::Eq(far, side_);
    return {near_slot, hn::Add(near_slot, hn::IfThenElseZero(parted, stride_)),
            near,      hn::IfThenZeroElse(parted, far),
            part,      parted};
  }

 private:
  /// voxel / side, as voxel · reciprocal / 2ᵇ. The reciprocal is less than 1 too large: that does
  /// not matter while voxel · side < 2ᵇ. Voxels are counted from the first of the box's first
  /// brick, in which some pixel lies, or its support: so they are below side + kMostVoxels + 6.
  static constexpr int kLongSide = 512;
  static constexpr int kBitsOfShortSides = 20;
  static constexpr int kBitsOfLongSides = 28;

  HWY_INLINE PositionVector brick_of(PositionVector voxel) const {
    return hn::ShiftRightSame(hn::Mul(voxel, reciprocal_), reciprocal_bits_);
  }

  PositionVector base_;
  PositionVector next_;
  PositionVector side_;
  PositionVector stride_;
  PositionVector first_;
  PositionVector last_;
  int reciprocal_bits_;
  PositionVector reciprocal_;
};

/// The positions of a row's pixels along one axis, vector by vector. Behind the last pixel its
/// position goes on.
class AxisPositions {
 public:
  HWY_INLINE AxisPositions(const RowAxis& axis, int count)
      : pixels_(hn::Iota(Positions(), 0)),
        last_(hn::Set(Positions(), count - 1)),
        start_(hn::Set(Positions(), axis.start)),
        step_(hn::Set(Positions(), axis.step)) {}

  HWY_INLINE PositionVector from(int first) const {
    const auto pixels = hn::Min(hn::Add(pixels_, hn::Set(Positions(), first)), last_);
    return hn::Add(hn::Mul(pixels, step_), start_);
  }

 private:
  PositionVector pixels_;
  PositionVector last_;
  PositionVector start_;
  PositionVector step_;
};

}  // namespace biotomy::reconstruct::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
