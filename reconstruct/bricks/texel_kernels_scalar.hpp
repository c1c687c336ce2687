#pragma once

// The kernels of texel_kernels.hpp in plain C++: what a processor without vectors runs, and what
// the vector kernels are tested against. With 8 bits the linear one agrees with them to the bit.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "reconstruct/bricks/row_path.hpp"
#include "reconstruct/bricks/texel_blocks.hpp"
#include "reconstruct/bricks/texel_kernels.hpp"

namespace biotomy::reconstruct::scalar {

inline std::size_t find_bricks(const RowPath& path, int count, std::int32_t* found) {
  std::size_t total = 0;
  for (int i = 0; i < count; ++i) {
    const std::array<AxisPlace, 3> places{AxisPlace(path.axes[0], i), AxisPlace(path.axes[1], i),
                                          AxisPlace(path.axes[2], i)};
    SupportBricks bricks{
        path.slot(places[0].near_brick, places[1].near_brick, places[2].near_brick), 0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bricks.further |= (places[axis].far_brick != places[axis].near_brick ? 1U : 0U) << axis;
    }
    found[total] = bricks.number();
    total += i == 0 || found[total] != found[total - 1] ? 1 : 0;
  }
  return total;
}

template <typename Level>
void place_row(const RowPath& path, int count, const std::byte* const* bricks,
               PixelPlaces<Level>& places) {
  constexpr int kSide = TexelBlocks::kSide;
  constexpr int kTexel = TexelBlocks::kColours * static_cast<int>(sizeof(Level));
  constexpr int kBlock = TexelBlocks::kBlockLevels * static_cast<int>(sizeof(Level));
  const AxisPlace layer(path.axes[2], 0);
  places.in_a_layer = path.stays_in_a_layer();
  places.crosses = !path.stays_in_a_layer() || layer.near_brick != layer.far_brick;
  places.down = std::ptrdiff_t{layer.far - layer.near} * path.layer_bytes;
  places.parted_count = 0;
  for (int i = 0; i < count; ++i) {
    const AxisPlace x(path.axes[0], i);
    const AxisPlace y(path.axes[1], i);
    const AxisPlace z(path.axes[2], i);
    const auto texel = [&](int x_brick, int column, bool next_row, bool next_layer) {
      const int row = next_row ? y.far : y.near;
      return bricks[path.slot(x_brick, next_row ? y.far_brick : y.near_brick,
                              next_layer ? z.far_brick : z.near_brick)] +
             std::ptrdiff_t{column / kSide * kBlock + column % kSide * kTexel +
                            row / kSide * path.block_row_bytes +
                            row % kSide * (kSide + 1) * kTexel +
                            (next_layer ? z.far : z.near) * path.layer_bytes};
    };
    const auto pixel = static_cast<std::size_t>(i);
    for (std::size_t row = 0; row < 2; ++row) {
      places.upper[row][pixel] = texel(x.near_brick, x.near, row == 1, false);
      if (places.crosses) {
        places.lower[row][pixel] = texel(x.near_brick, x.near, row == 1, true);
      }
    }
    places.x[pixel] = PixelPlaces<Level>::part(x.part);
    places.y[pixel] = PixelPlaces<Level>::part(y.part);
    places.z[pixel] = PixelPlaces<Level>::part(z.part);
    if (x.far_brick != x.near_brick) {
      places.parted[places.parted_count++] = {
          i,
          {texel(x.far_brick, x.far, false, false), texel(x.far_brick, x.far, true, false)},
          {texel(x.far_brick, x.far, false, true), texel(x.far_brick, x.far, true, true)}};
    }
  }
}

template <typename Level>
Level level_at(const std::byte* texels, int number) {
  Level level{};
  std::memcpy(&level, texels + static_cast<std::size_t>(number) * sizeof level, sizeof level);
  return level;
}

/// The first and the second mixed, as the vectors' instructions do it: the upper 16 bits of each
/// product.
inline unsigned mixed(unsigned first, unsigned second, std::uint16_t part) {
  constexpr unsigned kMost = 0xFFFF;
  return (first * (kMost - part) >> 16U) + (second * part >> 16U);
}
inline float mixed(float first, float second, float part) {
  return first + (second - first) * part;
}

/// A level as it is mixed, and back.
inline unsigned widened(std::uint8_t level) {
  return static_cast<unsigned>(level) << 8U;
}
inline float widened(std::uint16_t level) {
  return level;
}
inline std::uint8_t narrowed(unsigned level) {
  return static_cast<std::uint8_t>((level + kHalfLevel) >> 8U);
}
inline std::uint16_t narrowed(float level) {
  return static_cast<std::uint16_t>(std::floor(level + 0.5F));
}

template <typename Level>
void mix_linear(const PixelPlaces<Level>& places, std::size_t count, const PairLines<Level>& ahead,
                Level* rgb) {
  for (std::size_t i = 0; i < count; ++i) {
    ahead.ask(i, i + 1);
    const auto z = places.z[places.in_a_layer ? 0 : i];
    for (int colour = 0; colour < TexelBlocks::kColours; ++colour) {
      const auto along_y = [&](int texel) {
        const int level = TexelBlocks::kColours * texel + colour;
        const auto along_z = [&](std::size_t row) {
          return mixed(widened(level_at<Level>(places.upper[row][i], level)),
                       widened(level_at<Level>(places.below(row, i), level)), z);
        };
        return mixed(along_z(0), along_z(1), places.y[i]);
      };
      *rgb++ = narrowed(mixed(along_y(0), along_y(1), places.x[i]));
    }
  }
}

template <typename Level>
void mix_straight(const StraightRun& run, const StraightParts<Level>& parts, Level* rgb) {
  for (std::size_t i = run.first; i < run.first + run.count; ++i) {
    const std::size_t place = (i / TexelBlocks::kSide * TexelBlocks::kBlockLevels +
                               i % TexelBlocks::kSide * TexelBlocks::kColours) *
                              sizeof(Level);
    for (int colour = 0; colour < TexelBlocks::kColours; ++colour) {
      const auto along_z = [&](std::size_t row) {
        return mixed(widened(level_at<Level>(run.upper[row] + place, colour)),
                     widened(level_at<Level>(run.lower[row] + place, colour)), parts.z);
      };
      const auto along_y = mixed(along_z(0), along_z(1), parts.y);
      *rgb++ = narrowed(mixed(along_y, along_y, typename PixelPlaces<Level>::Part{0}));
    }
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

}  // namespace biotomy::reconstruct::scalar
