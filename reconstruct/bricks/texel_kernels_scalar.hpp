#pragma once

// The kernels of texel_kernels.hpp in plain C++: what a processor without vectors runs, and what
// the vector kernels are tested against. With 8 bits the linear one agrees with them to the bit.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include "reconstruct/bricks/brick_runs.hpp"
#include "reconstruct/bricks/texel_blocks.hpp"
#include "reconstruct/bricks/texel_kernels.hpp"

namespace biotomy::reconstruct::scalar {

template <typename Level>
void place_runs(const RowPath& path, std::span<const BrickRun> runs, const std::byte* const* bricks,
                PixelPlaces<Level>& places) {
  constexpr int kSide = TexelBlocks::kSide;
  constexpr int kTexel = TexelBlocks::kColours * static_cast<int>(sizeof(Level));
  constexpr int kBlock = 64 * static_cast<int>(sizeof(Level));
  for (const BrickRun& run : runs) {
    const BrickPair& x_bricks = run.bricks[0];
    const BrickPair& y_bricks = run.bricks[1];
    const BrickPair& z_bricks = run.bricks[2];
    for (int i = run.first; i < run.last && !run.parted; ++i) {
      const TexelPair x = texel_pair(path.axes[0], x_bricks, i);
      const TexelPair y = texel_pair(path.axes[1], y_bricks, i);
      const TexelPair z = texel_pair(path.axes[2], z_bricks, i);
      const auto place = [&](int y_brick, int row, int z_brick, int layer) {
        return bricks[path.slot(x_bricks.near, y_brick, z_brick)] +
               std::ptrdiff_t{x.near / kSide * kBlock + x.near % kSide * kTexel +
                              row / kSide * path.block_row_bytes +
                              row % kSide * (kSide + 1) * kTexel + layer * path.layer_bytes};
      };
      const auto pixel = static_cast<std::size_t>(i);
      places.upper[0][pixel] = place(y_bricks.near, y.near, z_bricks.near, z.near);
      places.upper[1][pixel] = place(y_bricks.far, y.far, z_bricks.near, z.near);
      if (places.crosses) {
        places.lower[0][pixel] = place(y_bricks.near, y.near, z_bricks.far, z.far);
        places.lower[1][pixel] = place(y_bricks.far, y.far, z_bricks.far, z.far);
      }
      places.x[pixel] = PixelPlaces<Level>::part(x.part);
      places.y[pixel] = PixelPlaces<Level>::part(y.part);
      places.z[pixel] = PixelPlaces<Level>::part(z.part);
    }
  }
}

/// A level of the left (x = 0) or right texel of a pair.
template <typename Level>
Level level_of(const std::byte* pair, int x, int colour) {
  Level level{};
  std::memcpy(&level,
              pair + static_cast<std::size_t>(x * TexelBlocks::kColours + colour) * sizeof(Level),
              sizeof level);
  return level;
}

/// a and b mixed, as processors' instruction for it does: (d · part + 2¹⁴) / 2¹⁵ is added to a.
inline int mixed(int a, int b, std::int16_t part) {
  return a + (((b - a) * part + (1 << 14)) >> 15);
}
inline float mixed(float a, float b, float part) {
  return a + (b - a) * part;
}

template <typename Level>
void mix_linear(const PixelPlaces<Level>& places, std::size_t count, Level* pixels) {
  constexpr bool kBytes = sizeof(Level) == 1;
  using Value = std::conditional_t<kBytes, int, float>;
  constexpr Value kScale = kBytes ? 128 : 1;  // 7 bits below a level
  for (std::size_t i = 0; i < count; ++i) {
    for (int colour = 0; colour < TexelBlocks::kColours; ++colour) {
      std::array<Value, 2> along_x{};
      for (int x = 0; x < 2; ++x) {
        std::array<Value, 2> along_y{};
        for (std::size_t row = 0; row < 2; ++row) {
          const std::byte* upper = places.upper[row][i];
          const std::byte* lower = places.crosses ? places.lower[row][i] : upper + places.down;
          along_y[row] =
              mixed(static_cast<Value>(level_of<Level>(upper, x, colour)) * kScale,
                    static_cast<Value>(level_of<Level>(lower, x, colour)) * kScale, places.z[i]);
        }
        along_x[static_cast<std::size_t>(x)] = mixed(along_y[0], along_y[1], places.y[i]);
      }
      const Value sum = mixed(along_x[0], along_x[1], places.x[i]);
      pixels[4 * i + static_cast<std::size_t>(colour)] =
          kBytes ? static_cast<Level>((static_cast<int>(sum) + 64) >> 7)
                 : static_cast<Level>(static_cast<float>(sum) + 0.5F);
    }
    pixels[4 * i + 3] = 0;
  }
}

template <typename Level>
void mix_straight(const StraightRun& run, const StraightParts<Level>& parts, Level* rgb) {
  PixelPlaces<Level> places;
  places.resize(1);
  places.crosses = true;
  places.y[0] = parts.y;
  places.z[0] = parts.z;
  for (std::size_t i = run.first; i < run.first + run.count; ++i) {
    const std::size_t levels = i / TexelBlocks::kSide * TexelBlocks::kBlockLevels +
                               i % TexelBlocks::kSide * TexelBlocks::kColours;
    for (std::size_t row = 0; row < 2; ++row) {
      places.upper[row][0] = run.upper[row] + levels * sizeof(Level);
      places.lower[row][0] = run.lower[row] + levels * sizeof(Level);
    }
    std::array<Level, 4> pixel{};
    scalar::mix_linear(places, 1, pixel.data());
    rgb = std::copy_n(pixel.begin(), 3, rgb);
  }
}

/// Of the voxels at −1, 0, 1 and 2 for a point at `part` (Keys 1981, equation 4 with a = −½).
inline std::array<float, 4> catmull_rom(float part) {
  const float t = part;
  const float t2 = t * t;
  const float t3 = t2 * t;
  return {0.5F * (-t3 + 2.0F * t2 - t), 0.5F * (3.0F * t3 - 5.0F * t2 + 2.0F),
          0.5F * (-3.0F * t3 + 4.0F * t2 + t), 0.5F * (t3 - t2)};
}

template <typename Level>
void mix_cubic(const Level* texels, const std::array<float, 3>& part, Level* pixel) {
  constexpr auto kMost = static_cast<float>(std::numeric_limits<Level>::max());
  const std::array<float, 4> x = catmull_rom(part[0]);
  const std::array<float, 4> y = catmull_rom(part[1]);
  const std::array<float, 4> z = catmull_rom(part[2]);
  for (std::size_t colour = 0; colour < 4; ++colour) {
    float sum = 0.5F;
    for (std::size_t i = 0; i < 64; ++i) {
      sum += x[i % 4] * y[i / 4 % 4] * z[i / 16] * static_cast<float>(texels[4 * i + colour]);
    }
    pixel[colour] = static_cast<Level>(std::clamp(sum, 0.0F, kMost));
  }
}

template <typename Level>
void pack_pixels(const Level* pixels, std::size_t count, Level* rgb) {
  for (std::size_t i = 0; i < count; ++i) {
    std::copy_n(pixels + 4 * i, 3, rgb + 3 * i);
  }
}

}  // namespace biotomy::reconstruct::scalar
