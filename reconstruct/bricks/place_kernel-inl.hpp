// Included once for each vector width: see texel_kernels.cpp.
#if defined(BIOTOMY_PLACE_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BIOTOMY_PLACE_KERNEL_INL
#undef BIOTOMY_PLACE_KERNEL_INL
#else
#define BIOTOMY_PLACE_KERNEL_INL
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "reconstruct/bricks/axis_vectors-inl.hpp"
#include "reconstruct/bricks/row_path.hpp"
#include "reconstruct/bricks/texel_blocks.hpp"
#include "reconstruct/bricks/texel_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace biotomy::reconstruct::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE void store_part(PositionVector position, std::uint16_t* out) {
  constexpr int kPartBits = 16;
  const hn::RebindToUnsigned<Positions> d;
  const hn::Rebind<std::uint16_t, Positions> d16;
  const auto shifted = hn::BitCast(d, hn::ShiftRight<kFractionBits - kPartBits>(position));
  hn::StoreU(hn::TruncateTo(d16, shifted), d16, out);
}

HWY_INLINE void store_part(PositionVector position, float* out) {
  constexpr float kUnit = 1.0F / static_cast<float>(1 << kFractionBits);
  const Positions d;
  const hn::RebindToFloat<Positions> df;
  const auto part = hn::And(position, hn::Set(d, (1 << kFractionBits) - 1));
  hn::StoreU(hn::Mul(hn::ConvertTo(df, part), hn::Set(df, kUnit)), df, out);
}

constexpr int kSide = TexelBlocks::kSide;
static_assert((kSide & (kSide - 1)) == 0, "a texel's place in its block is the end of its number");

/// What texels contribute along one axis to their places in a brick: as many bytes as from a block
/// to the next, and within a block as many as from a texel, or a row of them, to the next.
class AlongBlocks {
 public:
  HWY_INLINE AlongBlocks(int block_bytes, int texel_bytes)
      : step_(hn::Set(Positions(), block_bytes / kSide)),
        excess_(hn::Set(Positions(), block_bytes / kSide - texel_bytes)),
        within_(hn::Set(Positions(), kSide - 1)) {}

  HWY_INLINE PositionVector of(PositionVector texel) const {
    return hn::Sub(hn::Mul(texel, step_), hn::Mul(hn::And(texel, within_), excess_));
  }

 private:
  PositionVector step_;
  PositionVector excess_;
  PositionVector within_;
};

using Addresses = hn::CappedTag<std::int64_t, kRoomPixels / 2>;
using AddressVector = hn::Vec<Addresses>;
static_assert(sizeof(const std::byte*) == sizeof(std::int64_t),
              "vectors hold places in memory as 64 bits");

/// Where the bricks of a vector's pixels begin: of its first half, and of the other.
struct BrickAddresses {
  AddressVector low;
  AddressVector high;
};

using HalfPositions = hn::Half<Positions>;
using HalfVector = hn::Vec<HalfPositions>;

HWY_INLINE HalfVector lower_half(PositionVector numbers) {
  return hn::LowerHalf(HalfPositions(), numbers);
}
HWY_INLINE HalfVector upper_half(PositionVector numbers) {
  return hn::UpperHalf(HalfPositions(), numbers);
}

/// Of one half. Mostly its pixels lie in one brick, and to look for one is quicker than for each.
HWY_INLINE AddressVector bricks_at(const std::byte* const* bricks, HalfVector slots) {
  const Addresses d;
  const auto* const table = reinterpret_cast<const std::int64_t*>(bricks);
  const std::int32_t first = hn::GetLane(slots);
  if (hn::AllTrue(HalfPositions(), hn::Eq(slots, hn::Set(HalfPositions(), first)))) {
    return hn::Set(d, table[first]);
  }
  return hn::GatherIndex(d, table, hn::PromoteTo(d, slots));
}

HWY_INLINE BrickAddresses bricks_at(const std::byte* const* bricks, PositionVector slots) {
  return {bricks_at(bricks, lower_half(slots)), bricks_at(bricks, upper_half(slots))};
}

HWY_INLINE void store_places(const BrickAddresses& bricks, PositionVector offsets,
                             const std::byte** out) {
  const Addresses d;
  auto* const places = reinterpret_cast<std::int64_t*>(out);
  hn::StoreU(hn::Add(bricks.low, hn::PromoteTo(d, lower_half(offsets))), d, places);
  hn::StoreU(hn::Add(bricks.high, hn::PromoteTo(d, upper_half(offsets))), d, places + hn::Lanes(d));
}

/// How a row's pixels may lie.
enum class Layers {
  one_brick,   ///< in a layer, and the layer below is in the same bricks
  two_bricks,  ///< in a layer, and the layer below is in other bricks
  many         ///< the row crosses the layers
};

/// A row's parted pixels, collected without a branch: nothing foretells which vectors have one.
// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): cleared for each row it would cost
class PartedPixels {
 public:
  /// Those of a vector's pixels, of which the first is `first`. `near` and `far` are the slots of
  /// their rows of texels in the upper layer, `below` is from there to those in the lower one.
  HWY_INLINE void add(PositionMask parted, int first, int count, PositionVector near,
                      PositionVector far, PositionVector below) {
    const Positions d;
    const auto pixels = hn::Add(hn::Iota(d, 0), hn::Set(d, first));
    const auto chosen = hn::And(parted, hn::Lt(pixels, hn::Set(d, count)));
    hn::StoreU(hn::Compress(pixels, chosen), d, pixels_ + count_);
    hn::StoreU(hn::Compress(near, chosen), d, near_ + count_);
    hn::StoreU(hn::Compress(far, chosen), d, far_ + count_);
    hn::StoreU(hn::Compress(below, chosen), d, below_ + count_);
    count_ += hn::CountTrue(d, chosen);
  }

  /// Finds their right texels: the first of the next bricks' rows, as many bytes before the left
  /// ones' place as the last texel of a row is behind the first.
  template <typename Level>
  void note(const std::byte* const* bricks, int to_next_brick, std::ptrdiff_t last_texel,
            PixelPlaces<Level>& places) const {
    const auto right_of = [&](const std::byte* left, std::int32_t slot) {
      return bricks[slot + to_next_brick] + (left - bricks[slot] - last_texel);
    };
    places.parted_count = count_;
    for (std::size_t i = 0; i < count_; ++i) {
      const auto pixel = static_cast<std::size_t>(pixels_[i]);
      PartedPixel& parted = places.parted[i];
      parted.pixel = pixels_[i];
      for (std::size_t row = 0; row < 2; ++row) {
        const std::int32_t slot = row == 0 ? near_[i] : far_[i];
        parted.upper[row] = right_of(places.upper[row][pixel], slot);
        parted.lower[row] = places.crosses ? right_of(places.lower[row][pixel], slot + below_[i])
                                           : parted.upper[row] + places.down;
      }
    }
  }

 private:
  static constexpr std::size_t kRoom = kMostPixels + kRoomPixels;
  std::size_t count_ = 0;
  std::int32_t pixels_[kRoom];
  std::int32_t near_[kRoom];
  std::int32_t far_[kRoom];
  std::int32_t below_[kRoom];
};

template <bool kBorder, Layers kLayers, typename Level>
HWY_INLINE void place_row_by(const RowPath& path, int count, const std::byte* const* bricks,
                             PixelPlaces<Level>& places) {
  constexpr int kTexelBytes = TexelBlocks::kColours * static_cast<int>(sizeof(Level));
  constexpr int kBlockBytes = TexelBlocks::kBlockLevels * static_cast<int>(sizeof(Level));
  constexpr bool kCrosses = kLayers != Layers::one_brick;
  using Places = const std::byte**;
  using Part = typename PixelPlaces<Level>::Part;
  const Positions d;
  const AxisVectors<kBorder> x_axis(path.axes[0]);
  const AxisVectors<kBorder> y_axis(path.axes[1]);
  const AxisVectors<kBorder> z_axis(path.axes[2]);
  const AxisPositions x_positions(path.axes[0], count);
  const AxisPositions y_positions(path.axes[1], count);
  const AxisPositions z_positions(path.axes[2], count);
  const AlongBlocks along_x(kBlockBytes, kTexelBytes);
  const AlongBlocks along_y(path.block_row_bytes, (kSide + 1) * kTexelBytes);
  const auto layer_bytes = hn::Set(d, path.layer_bytes);
  const Places upper_out[2] = {places.upper[0].data(), places.upper[1].data()};
  const Places lower_out[2] = {places.lower[0].data(), places.lower[1].data()};
  Part* const x_out = places.x.data();
  Part* const y_out = places.y.data();
  Part* const z_out = places.z.data();
  PartedPixels parted;
  AxisPlaces z = z_axis.at(z_positions.from(0));
  store_part(z.part, z_out);
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    const AxisPlaces x = x_axis.at(x_positions.from(i));
    const AxisPlaces y = y_axis.at(y_positions.from(i));
    if constexpr (kLayers == Layers::many) {
      z = z_axis.at(z_positions.from(i));
      store_part(z.part, z_out + i);
    }
    const auto near = hn::Add(along_x.of(x.near), along_y.of(y.near));
    const auto far = hn::Add(along_x.of(x.near), along_y.of(y.far));
    const auto near_slot = hn::Add(x.near_slot, hn::Add(y.near_slot, z.near_slot));
    const auto far_slot = hn::Add(x.near_slot, hn::Add(y.far_slot, z.near_slot));
    const auto below = hn::Sub(z.far_slot, z.near_slot);
    const bool one_row_of_bricks = hn::AllFalse(d, y.parted);
    const auto place = [&](PositionVector from_upper, PositionVector layer,
                           const Places* out) HWY_ATTR {
      const auto in_layer = hn::Mul(layer, layer_bytes);
      const BrickAddresses at_near = bricks_at(bricks, hn::Add(near_slot, from_upper));
      store_places(at_near, hn::Add(near, in_layer), out[0] + i);
      store_places(one_row_of_bricks ? at_near : bricks_at(bricks, hn::Add(far_slot, from_upper)),
                   hn::Add(far, in_layer), out[1] + i);
    };
    place(hn::Zero(d), z.near, upper_out);
    if constexpr (kCrosses) {
      place(below, z.far, lower_out);
    }
    store_part(x.part, x_out + i);
    store_part(y.part, y_out + i);
    parted.add(x.parted, i, count, near_slot, far_slot, below);
  }
  const int last = path.axes[0].side - 1;
  parted.note(bricks, path.axes[0].slot_stride,
              last / kSide * kBlockBytes + last % kSide * kTexelBytes, places);
}

template <bool kBorder, typename Level>
HWY_INLINE void place_row_at(const RowPath& path, int count, const std::byte* const* bricks,
                             PixelPlaces<Level>& places) {
  const AxisPlace z(path.axes[2], 0);
  places.down = std::ptrdiff_t{z.far - z.near} * path.layer_bytes;
  places.in_a_layer = path.stays_in_a_layer();
  places.crosses = !path.stays_in_a_layer() || z.near_brick != z.far_brick;
  if (!path.stays_in_a_layer()) {
    place_row_by<kBorder, Layers::many>(path, count, bricks, places);
  } else if (places.crosses) {
    place_row_by<kBorder, Layers::two_bricks>(path, count, bricks, places);
  } else {
    place_row_by<kBorder, Layers::one_brick>(path, count, bricks, places);
  }
}

template <typename Level>
void place_row(const RowPath& path, int count, const std::byte* const* bricks,
               PixelPlaces<Level>& places) {
  if (path.is_inside(count)) {
    place_row_at<false>(path, count, bricks, places);
  } else {
    place_row_at<true>(path, count, bricks, places);
  }
}

}  // namespace biotomy::reconstruct::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
