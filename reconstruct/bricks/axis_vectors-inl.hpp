// Included once for each vector width: see texel_kernels.cpp.
#if defined(BIOTOMY_AXIS_VECTORS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BIOTOMY_AXIS_VECTORS_INL
#undef BIOTOMY_AXIS_VECTORS_INL
#else
#define BIOTOMY_AXIS_VECTORS_INL
#endif

#include <algorithm>
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
  HWY_INLINE explicit AxisVectors(const RowAxis& axis) : AxisVectors(axis, first_brick(axis)) {}

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
    // The product may be one brick short of the quotient: the remainder tells.
    const auto estimate = hn::ShiftRight<kReciprocalBits>(hn::Mul(voxel, reciprocal_));
    const auto remainder = hn::Sub(voxel, hn::Mul(estimate, side_));
    const auto short_by_one = hn::Gt(remainder, last_texel_);
    const auto near = hn::Sub(remainder, hn::IfThenElseZero(short_by_one, side_));
    const auto brick = hn::Sub(estimate, hn::VecFromMask(Positions(), short_by_one));
    const auto near_slot = hn::Add(hn::Mul(brick, stride_), slot_);
    const auto far = hn::Add(near, next);
    const auto parted = hn::Eq(far, side_);
    return {near_slot, hn::Add(near_slot, hn::IfThenElseZero(parted, stride_)),
            near,      hn::IfThenZeroElse(parted, far),
            part,      parted};
  }

 private:
  /// 1 / side in 2⁻²⁰, cut off. Voxels are counted from the row's first brick, so that they are
  /// at most side + kMostVoxels + 1: products fit into 31 bits, whatever the side, and fall short
  /// of the quotient by less than 1.
  static constexpr int kReciprocalBits = 20;

  /// The brick of the voxel before the row's first one along the axis, which rounding may reach;
  /// beyond the border: the border's.
  static int first_brick(const RowAxis& axis) {
    return std::clamp(axis.base - 1, axis.first, axis.last) / axis.side;
  }

  HWY_INLINE AxisVectors(const RowAxis& axis, int brick)
      : base_(hn::Set(Positions(), axis.base - brick * axis.side)),
        next_(hn::Set(Positions(), axis.next)),
        side_(hn::Set(Positions(), axis.side)),
        last_texel_(hn::Set(Positions(), axis.side - 1)),
        slot_(hn::Set(Positions(), brick * axis.slot_stride)),
        stride_(hn::Set(Positions(), axis.slot_stride)),
        first_(hn::Set(Positions(), axis.first - brick * axis.side)),
        last_(hn::Set(Positions(), axis.last - brick * axis.side)),
        reciprocal_(hn::Set(Positions(), (1 << kReciprocalBits) / axis.side)) {}

  PositionVector base_;
  PositionVector next_;
  PositionVector side_;
  PositionVector last_texel_;
  PositionVector slot_;
  PositionVector stride_;
  PositionVector first_;
  PositionVector last_;
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

  HWY_INLINE PositionVector of(PositionVector pixels) const {
    return hn::Add(hn::Mul(hn::Min(pixels, last_), step_), start_);
  }
  HWY_INLINE PositionVector from(int first) const {
    return of(hn::Add(pixels_, hn::Set(Positions(), first)));
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
