#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace biotomy::reconstruct {

/// Positions are in fixed point: a number of voxels with kFractionBits after the point. Whole steps
/// are added to them, so nothing but the step's own rounding (2⁻²³ voxel at most) adds up over the
/// pixels that are placed together: up to kMostPixels, over up to kMostVoxels.
inline constexpr int kFractionBits = 22;
inline constexpr int kMostPixels = 256;
inline constexpr int kMostVoxels = (1 << (31 - kFractionBits)) - 2;

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

  std::int32_t position(int pixel) const { return start + pixel * step; }
  int voxel(int pixel) const { return base + (position(pixel) >> kFractionBits); }

  /// Whether pixels 0 to `count` - 1 lie in the volume with the voxels that they are mixed with.
  bool is_inside(int count) const {
    const auto [low, high] = std::minmax({voxel(0), voxel(count - 1)});
    return low >= first && high + next <= last;
  }
};

/// A pixel along one axis, for linear: the voxel that it lies in and the one that it is mixed with,
/// as texels of their bricks. Beyond the volume's border the border's colour goes on, mixed with no
/// other.
struct AxisPlace {
  int near_brick = 0;  ///< number in the box, along this axis
  int far_brick = 0;
  int near = 0;  ///< texel
  int far = 0;
  float part = 0.0F;  ///< the pixel's place between them, below 1

  AxisPlace(const RowAxis& axis, int pixel) {
    constexpr std::int32_t kUnit = 1 << kFractionBits;
    const int voxel = axis.voxel(pixel);
    const int inside = std::clamp(voxel, axis.first, axis.last);
    const bool mixes = voxel == inside && voxel < axis.last;
    const int next = mixes ? inside + axis.next : inside;
    near_brick = inside / axis.side;
    far_brick = next / axis.side;
    near = inside % axis.side;
    far = next % axis.side;
    const std::int32_t fraction = axis.position(pixel) & (kUnit - 1);
    part = mixes ? static_cast<float>(fraction) / static_cast<float>(kUnit) : 0.0F;
  }
};

struct RowPath {
  std::array<RowAxis, 3> axes;  ///< x, y, z
  int block_row_bytes = 0;      ///< of a brick, as TexelBlocks says
  int layer_bytes = 0;

  bool stays_in_a_layer() const { return axes[2].step == 0; }

  /// Whether RowAxis says so of all axes.
  bool is_inside(int count) const {
    return axes[0].is_inside(count) && axes[1].is_inside(count) && axes[2].is_inside(count);
  }

  /// The number in the box of the brick with these numbers along x, y and z.
  int slot(int x, int y, int z) const {
    return x * axes[0].slot_stride + y * axes[1].slot_stride + z * axes[2].slot_stride;
  }
};

/// The bricks that the support of a pixel for linear lies in: that of its voxel, and along some
/// axes also the next.
struct SupportBricks {
  static constexpr unsigned kAxisBits = 3;

  std::int32_t slot = 0;  ///< of its voxel's
  unsigned further = 0;   ///< bit 0: also the next along x; bit 1: along y; bit 2: along z

  /// Both in one number, as kernels tell them.
  static SupportBricks of(std::int32_t number) {
    return {number >> kAxisBits, static_cast<unsigned>(number) & ((1U << kAxisBits) - 1)};
  }
  std::int32_t number() const { return slot << kAxisBits | static_cast<std::int32_t>(further); }
};

}  // namespace biotomy::reconstruct
