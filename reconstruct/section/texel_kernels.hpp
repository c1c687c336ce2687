#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace biotomy::reconstruct {

// The innermost loops of the sampler, for levels of 8 bits (`Level` std::uint8_t) and of 16
// (std::uint16_t). Written once in Highway and compiled for every vector width; the widest that the
// processor has is chosen when the program runs. Colours come out as pixels of four levels, R G B
// and one that means nothing, and are packed to R G B at the end.
//
// A row of pixels is sampled in two passes: first all its places are computed, then its colours. In
// one pass the second half would wait for the first at every step, as addresses that a vector has
// computed reach the loads through memory.

/// Positions within a brick in fixed point: an unsigned number of voxels with kFractionBits after
/// the point. Whole steps are added to them, so nothing but the step's own rounding (2⁻²³ voxel at
/// most) adds up; runs end before that is a level, and are never longer than kLongestRun pixels.
inline constexpr int kFractionBits = 22;
inline constexpr int kLongestBrickSide = 1 << (31 - kFractionBits);
inline constexpr int kLongestRun = 256;

/// Kernels work on whole vectors: so many places, and pixels, behind the last are read and written.
inline constexpr std::size_t kRoomPixels = 16;

/// Pixels of a row whose support lies in one brick (or, from one layer to the next, in two): pixel
/// i lies at start + i·step. Bricks are laid out as TexelBlocks says.
struct TexelRun {
  const std::byte* upper = nullptr;  ///< texel (0, 0, 0) of the brick: where positions count from
  const std::byte* lower = nullptr;  ///< the texel after it along z
  int block_row_bytes = 0;           ///< as TexelBlocks says
  int layer_bytes = 0;
  int next_row = 1;  ///< 0 where the pixels lie on voxel centres along y: no neighbour to mix with
  std::array<std::uint32_t, 3> start{};  ///< x, y, z
  std::array<std::int32_t, 3> step{};
  int count = 0;  ///< up to kLongestRun
};

/// Where the pixels of a row lie, for the linear kernel: the pair of texels (at the whole part of x
/// and the next) in the row of the whole part of y and in the next row, both in the layer of the
/// whole part of z; the pairs in the next layer lie `down` bytes behind those or, where that is in
/// another brick, at `lower`. And the place between the texels: 15 bits with levels of 8 bits,
/// float with 16.
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

/// The places of the run's pixels, from `first` on; up to kRoomPixels behind them are overwritten.
template <typename Level>
void place_run(const TexelRun& run, PixelPlaces<Level>& places, std::size_t first);

/// Trilinear. Radius 1 voxel, support 2, order 1 (continuous). Within ±1 level of exact arithmetic,
/// and exactly the voxel's own colour at a voxel's centre. With 8 bits the arithmetic is of 16-bit
/// fixed point with 7 bits below a level (weights of 15 bits, rounded at each of the three steps:
/// at most 0.03 level in all), with 16 bits it is float.
template <typename Level>
void mix_linear(const PixelPlaces<Level>& places, std::size_t count, Level* pixels);

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
