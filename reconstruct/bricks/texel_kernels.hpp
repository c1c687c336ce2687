#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "reconstruct/bricks/pixel_places.hpp"
#include "reconstruct/bricks/row_path.hpp"

namespace biotomy::reconstruct {

// The innermost loops of the sampler, for levels of 8 bits (`Level` std::uint8_t) and of 16
// (std::uint16_t). Written once in Highway and compiled for every vector width; the widest that the
// processor has is chosen when the program runs.
//
// A row of pixels is sampled in two passes: first all its places are computed, then its colours. In
// one pass the second half would wait for the first at every step, as addresses that a vector has
// computed reach the loads through memory.

/// Numbers that find_bricks may write at most: those of all pixels, and of the first and the last
/// of each kRoomPixels of them once more. Behind them there is room for a vector.
inline constexpr std::size_t kMostFound = kMostPixels + 2 * kRoomPixels;
inline constexpr std::size_t kFoundRoom = kMostFound + kRoomPixels;

/// Writes to `found`, which has kFoundRoom numbers, some of SupportBricks: the bricks that these
/// tell are those of the pixels 0 to `count` - 1 of the row, and no others. A number may come more
/// than once. Returns how many came.
std::size_t find_bricks(const RowPath& path, int count, std::int32_t* found);

/// Places the pixels 0 to `count` - 1 of a row. `bricks` are the box's, by slot: all that
/// find_bricks tells are there. Behind the last pixel its place goes on.
template <typename Level>
void place_row(const RowPath& path, int count, const std::byte* const* bricks,
               PixelPlaces<Level>& places);

/// Added before the bits below a level are cut off. Each of the three steps of mixing levels of 8
/// bits loses 0 to 3 of 256 parts of a level, as its two products are cut off and its weights add
/// up to 1 − 2⁻¹⁶: half of that is made up for.
inline constexpr int kHalfLevel = 128 + 4;

/// Trilinear. Radius 1 voxel, support 2, order 1 (continuous). Within ±1 level of exact arithmetic,
/// and exactly the voxel's own colour at a voxel's centre. With 8 bits the arithmetic is of 16-bit
/// fixed point with 8 bits below a level and weights of 16 bits, with 16 bits it is float. No pixel
/// is parted. Writes R G B. As many of the pixels `ahead` are asked for meanwhile.
template <typename Level>
void mix_linear(const PixelPlaces<Level>& places, std::size_t count, const PairLines<Level>& ahead,
                Level* rgb);

/// Pixels of a row that runs along x from voxel to voxel: their texels stand side by side in one
/// brick, and are mixed only with those of other rows.
struct StraightRun {
  /// Texel 0 of the brick's row of the whole part of y, and of the next row: in the layer of the
  /// whole part of z, and in the next layer.
  std::array<const std::byte*, 2> upper{};
  std::array<const std::byte*, 2> lower{};
  std::size_t first = 0;  ///< texel
  std::size_t count = 0;
};

/// The place of all pixels of such a row between the texels.
template <typename Level>
struct StraightParts {
  typename PixelPlaces<Level>::Part y{};
  typename PixelPlaces<Level>::Part z{};
};

/// Gives what mix_linear would in a fraction of the time.
template <typename Level>
void mix_straight(const StraightRun& run, const StraightParts<Level>& parts, Level* rgb);

/// Tricubic by Catmull-Rom (Keys 1981, a = −½). Radius 2 voxels, support 4, order 2 (continuous
/// with its first derivative; reproduces quadratics). In float; what overshoots is clamped.
/// `texels` are the 4³ of the support, R G B and a fourth level, x fastest, then y, then z; `part`
/// is the place between the middle ones, x, y, z. Writes R G B and a fourth level.
template <typename Level>
void mix_cubic(const Level* texels, const std::array<float, 3>& part, Level* pixel);

}  // namespace biotomy::reconstruct
