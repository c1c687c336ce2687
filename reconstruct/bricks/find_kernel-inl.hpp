// Included once for each vector width: see texel_kernels.cpp.
#if defined(BIOTOMY_FIND_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BIOTOMY_FIND_KERNEL_INL
#undef BIOTOMY_FIND_KERNEL_INL
#else
#define BIOTOMY_FIND_KERNEL_INL
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

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

/// Pixels beside each other that are looked at together.
constexpr int kSegment = static_cast<int>(kRoomPixels);

/// Whether the bricks of a segment's first pixel and of its last are neighbours along each axis.
inline bool steps_are_short(const RowPath& path) {
  return std::all_of(path.axes.begin(), path.axes.end(), [](const RowAxis& axis) {
    const std::int64_t across = std::int64_t{kSegment - 1} * std::abs(axis.step);
    return across <= std::int64_t{axis.side - 1} << kFractionBits;
  });
}

/// Tells the bricks of a row's pixels, of any of them.
template <bool kBorder, bool kInALayer>
class RowBricks {
 public:
  HWY_INLINE RowBricks(const RowPath& path, int count)
      : x_axis_(path.axes[0]),
        y_axis_(path.axes[1]),
        z_axis_(path.axes[2]),
        x_(path.axes[0], count),
        y_(path.axes[1], count),
        z_(path.axes[2], count),
        along_z_(brick_number(z_axis_.at(z_.from(0)), 2)) {}

  /// What each axis contributes to the number of SupportBricks.
  struct Numbers {
    PositionVector x;
    PositionVector y;
    PositionVector z;

    HWY_INLINE PositionVector sum() const { return hn::Add(hn::Add(x, y), z); }
  };

  HWY_INLINE Numbers of(PositionVector pixels) const {
    return {brick_number(x_axis_.at(x_.of(pixels)), 0), brick_number(y_axis_.at(y_.of(pixels)), 1),
            kInALayer ? along_z_ : brick_number(z_axis_.at(z_.of(pixels)), 2)};
  }

 private:
  AxisVectors<kBorder> x_axis_;
  AxisVectors<kBorder> y_axis_;
  AxisVectors<kBorder> z_axis_;
  AxisPositions x_;
  AxisPositions y_;
  AxisPositions z_;
  PositionVector along_z_;
};

/// Where two and more axes tell different numbers.
template <typename Numbers>
HWY_INLINE PositionMask differ_twice(const Numbers& a, const Numbers& b) {
  const auto x = hn::Ne(a.x, b.x);
  const auto y = hn::Ne(a.y, b.y);
  const auto z = hn::Ne(a.z, b.z);
  return hn::Or(hn::And(x, y), hn::And(z, hn::Or(x, y)));
}

/// Collects numbers without a branch: nothing foretells where they change.
class NumberList {
 public:
  HWY_INLINE explicit NumberList(std::int32_t* numbers) : numbers_(numbers) {}

  HWY_INLINE void add(PositionVector numbers, PositionMask chosen) {
    const Positions d;
    hn::StoreU(hn::Compress(numbers, chosen), d, numbers_ + count_);
    count_ += hn::CountTrue(d, chosen);
  }

  std::size_t count() const { return count_; }

 private:
  std::int32_t* numbers_;
  std::size_t count_ = 0;
};

/// Segment by segment. While steps are short, the pixels between two lie, along an axis, in no
/// other bricks than these. So where a segment's ends tell the same along all axes but one, all its
/// pixels lie in the ends' bricks; where they do not, its pixels are looked at one by one.
template <bool kBorder, bool kInALayer>
HWY_INLINE std::size_t find_bricks_by(const RowPath& path, int count, std::int32_t* found) {
  const Positions d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto pixels = hn::Iota(d, 0);
  const auto segments = hn::Mul(pixels, hn::Set(d, kSegment));
  const bool short_steps = steps_are_short(path);
  const RowBricks<kBorder, kInALayer> bricks(path, count);
  NumberList list(found);
  HWY_ALIGN std::int32_t unclear[kRoomPixels];
  HWY_ALIGN std::int32_t lasts[1 + kRoomPixels];
  lasts[0] = -1;  // no pixel has this number
  for (int first = 0; first < count; first += kSegment * lanes) {
    const auto firsts = hn::Add(segments, hn::Set(d, first));
    const auto at_first = bricks.of(firsts);
    const auto at_last = bricks.of(hn::Add(firsts, hn::Set(d, kSegment - 1)));
    const auto first_number = at_first.sum();
    const auto last_number = at_last.sum();
    hn::StoreU(last_number, d, lasts + 1);
    const auto is_unclear =
        short_steps ? differ_twice(at_first, at_last) : hn::Lt(firsts, hn::Set(d, count));
    hn::StoreU(hn::Compress(firsts, is_unclear), d, unclear);
    const std::size_t unclear_count = hn::CountTrue(d, is_unclear);
    for (std::size_t i = 0; i < unclear_count; ++i) {
      for (int pixel = 1; pixel < kSegment; pixel += lanes) {
        const auto these = hn::Add(pixels, hn::Set(d, unclear[i] + pixel));
        const auto number = bricks.of(these).sum();
        list.add(number, hn::Ne(number, bricks.of(hn::Sub(these, hn::Set(d, 1))).sum()));
      }
    }
    list.add(first_number, hn::Ne(first_number, hn::LoadU(d, lasts)));
    list.add(last_number, hn::Ne(last_number, first_number));
    lasts[0] = lasts[lanes];
  }
  return list.count();
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
