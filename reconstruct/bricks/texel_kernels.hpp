#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace biotomy::reconstruct {

// The innermost loops of the sampler, for levels of 8 bits (`Level` std::uint8_t) and of 16
// (std::uint16_t). Written once in Highway and compiled for every vector width; the widest that the
// processor has is chosen when the program runs. Colours come out as pixels of four levels, R G B
// and one that means nothing, and are packed to R G B at the end.
//
// A row of pixels is sampled in two passes: first all its places are computed, run by run, then its
// colours. In one pass the second half would wait for the first at every step, as addresses that a
// vector has computed reach the loads through memory.

/// Positions are in fixed point: a number of voxels with kFractionBits after the point. Whole steps
/// are added to them, so nothing but the step's own rounding (2⁻²³ voxel at most) adds up over the
/// pixels that are placed together: up to kMostPixels, over up to kMostVoxels.
inline constexpr int kFractionBits = 22;
inline constexpr int kMostPixels = 256;
inline constexpr int kMostVoxels = (1 << (31 - kFractionBits)) - 2;

/// Kernels work on whole vectors: so many places, and pixels, behind the last are read and written.
inline constexpr std::size_t kRoomPixels = 16;

/// A row of pixels along one axis, among the voxels of a box of bricks.
struct RowAxis {
  std::int32_t start = 0;  ///< of pixel 0, in fixed point, from voxel `base` on
  std::int32_t step = 0;
  int base = 0;   ///< voxels are counted from the box's first one
  int last = 0;   ///< the volume's last voxel: what is beyond it or before 0 is moved to the border
  int first = 0;  ///< the volume's first voxel, likewise
  int side = 1;   ///< of a brick
  int slot_stride = 1;  ///< from a brick's number in the box to the next one's
  int next = 1;  ///< 0 where all pixels lie on voxel centres: there is no neighbour to mix with
};

struct RowPath {
  std::array<RowAxis, 3> axes;  ///< x, y, z
  int block_row_bytes = 0;      ///< of a brick, as TexelBlocks says
  int layer_bytes = 0;

  /// The number in the box of the brick with these numbers along x, y and z.
  int slot(int x, int y, int z) const {
    return x * axes[0].slot_stride + y * axes[1].slot_stride + z * axes[2].slot_stride;
  }
};

/// Along one axis the bricks, by their number in the box, of a pixel's voxel and of the next, with
/// which it is mixed.
struct BrickPair {
  int near = 0;
  int far = 0;

  bool operator==(const BrickPair&) const = default;
};

/// Pixels of a row, from `first` to before `last`, whose supports for linear lie in the same
/// bricks.
struct BrickRun {
  int first = 0;
  int last = 0;
  std::array<BrickPair, 3> bricks;  ///< x, y, z

  /// Texels of the support have to be gathered one by one: the two of a pair are in different
  /// bricks, or one would be beyond the volume's border, or the row runs from layers of one brick
  /// into those of another.
  bool parted = false;
};

/// Where the pixels of a row lie, for the linear kernel: the pair of texels (at the whole part of x
/// and the next) in the row of the whole part of y and in the next row, both in the layer of the
/// whole part of z; the pairs in the next layer lie `down` bytes behind those or, where all of the
/// row's are in another brick, at `lower`. And the place between the texels: 15 bits with levels of
/// 8 bits, float with 16.
template <typename Level>
struct PixelPlaces {
  using Part = std::conditional_t<sizeof(Level) == 1, std::int16_t, float>;
  using Pairs = std::array<std::vector<const std::byte*>, 2>;  // in a row, and in the next

  Pairs upper;
  Pairs lower;  ///< filled and looked at only if `crosses`
  bool crosses = false;
  std::ptrdiff_t down = 0;
  std::vector<Part> x;
  std::vector<Part> y;
  std::vector<Part> z;

  void resize(std::size_t pixels) {
    for (Pairs* pairs : {&upper, &lower}) {
      for (auto& row : *pairs) {
        row.resize(pixels + kRoomPixels);
      }
    }
    for (auto* parts : {&x, &y, &z}) {
      parts->resize(pixels + kRoomPixels);
    }
  }

  /// A part, 0 to below 1, as it is kept here.
  static Part part(float value) {
    return static_cast<Part>(sizeof(Level) == 1 ? value * 32768.0F : value);
  }
};

/// Places the pixels of those of a row's runs that are not parted. `bricks` are the box's, by slot.
/// Up to kRoomPixels places behind each run are overwritten with places of nothing, before the next
/// run is placed.
template <typename Level>
void place_runs(const RowPath& path, std::span<const BrickRun> runs, const std::byte* const* bricks,
                PixelPlaces<Level>& places);

/// Trilinear. Radius 1 voxel, support 2, order 1 (continuous). Within ±1 level of exact arithmetic,
/// and exactly the voxel's own colour at a voxel's centre. With 8 bits the arithmetic is of 16-bit
/// fixed point with 7 bits below a level (weights of 15 bits, rounded at each of the three steps:
/// at most 0.03 level in all), with 16 bits it is float.
template <typename Level>
void mix_linear(const PixelPlaces<Level>& places, std::size_t count, Level* pixels);

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

/// Gives what mix_linear and pack_pixels would, R G B, in a fraction of the time.
template <typename Level>
void mix_straight(const StraightRun& run, const StraightParts<Level>& parts, Level* rgb);

/// Tricubic by Catmull-Rom (Keys 1981, a = −½). Radius 2 voxels, support 4, order 2 (continuous
/// with its first derivative; reproduces quadratics). In float; what overshoots is clamped.
/// `texels` are the 4³ of the support, R G B and a fourth level, x fastest, then y, then z; `part`
/// is the place between the middle ones, x, y, z.
template <typename Level>
void mix_cubic(const Level* texels, const std::array<float, 3>& part, Level* pixel);

/// R G B of pixels of four levels.
template <typename Level>
void pack_pixels(const Level* pixels, std::size_t count, Level* rgb);

}  // namespace biotomy::reconstruct
