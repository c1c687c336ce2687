#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "reconstruct/bricks/texel_blocks.hpp"
#include "reconstruct/store/codecs.hpp"
#include "reconstruct/store/volume.hpp"

namespace biotomy::reconstruct {

/// The voxels that a section is made of lie near its plane: each is at most `reach` voxels, along
/// each axis by itself, from some point of it. In voxels of one level, axes x, y, z. As it
/// stands, without a normal, everything is near.
struct PlaneReach {
  std::array<double, 3> normal{};  ///< of any length
  double offset = 0.0;             ///< normal · point, the same for all points of the plane
  double reach = 0.0;
};

/// Some of a brick's cells, a bit each.
using CellSet = std::uint64_t;

/// A brick is cut into 4 × 4 × 4 cells, so that of those that a plane crosses only the cells near
/// the plane need be decoded and laid out: a quarter to a half. Cells are whole blocks of texels
/// (TexelBlocks) along x and y and, along z, whole blocks of what is stored (VolumeLayout). Where a
/// side is too short for four there are fewer.
class BrickCells {
 public:
  static constexpr int kAlongAxis = 4;
  static constexpr std::size_t kCells = std::size_t{kAlongAxis} * kAlongAxis * kAlongAxis;

  /// `shape` is of the chunk: z, y, x.
  explicit BrickCells(const std::array<int, 3>& shape);

  CellSet all() const { return all_; }

  /// The layers of the brick from the first to the last that one of `cells` has a part in.
  ChunkLayers layers(CellSet cells) const;

  /// Texels along an axis, from `first` to before `end`.
  struct Stretch {
    int first = 0;
    int end = 0;
  };

  /// Where the cells with this number along an axis (0, 1, 2: x, y, z) lie; empty where there are
  /// fewer.
  Stretch stretch(std::size_t axis, int number) const {
    return stretches_[axis][static_cast<std::size_t>(number)];
  }

  static constexpr CellSet bit(int x, int y, int z) {
    return CellSet{1} << ((z * kAlongAxis + y) * kAlongAxis + x);
  }

  /// `f(box)` for boxes that together are `cells`, each cell once.
  template <typename F>
  void for_each_box(CellSet cells, F&& f) const {
    for (int z = 0; z < kAlongAxis; ++z) {
      for (int y = 0; y < kAlongAxis; ++y) {
        for (int x = 0; x < kAlongAxis; ++x) {
          const int first = x;
          while (x < kAlongAxis && (cells & bit(x, y, z)) != 0) {
            ++x;
          }
          if (first < x) {
            f(TexelBlocks::Box{{stretch(0, first).first, stretch(1, y).first, stretch(2, z).first},
                               {stretch(0, x - 1).end, stretch(1, y).end, stretch(2, z).end}});
          }
        }
      }
    }
  }

 private:
  std::array<std::array<Stretch, kAlongAxis>, 3> stretches_{};
  CellSet all_ = 0;
};

/// Which cells of a level's bricks lie near a plane.
class CellsNearPlane {
 public:
  CellsNearPlane(const BrickCells& cells, const std::array<int, 3>& shape, const PlaneReach& plane);

  CellSet of(ChunkIndex brick) const;

 private:
  using OfCells = std::array<double, BrickCells::kCells>;

  // From a brick to the next along an axis normal · point grows by so much.
  std::array<double, 3> brick_step_{};
  double offset_;
  OfCells middle_{};  // normal · the cell's middle, seen from its brick
  OfCells reach_{};   // how far that may be from the plane's, for the cell to be near
  CellSet all_;
};

}  // namespace biotomy::reconstruct
