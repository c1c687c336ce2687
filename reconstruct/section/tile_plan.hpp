#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "reconstruct/bricks/brick_source.hpp"
#include "reconstruct/bricks/row_path.hpp"
#include "reconstruct/bricks/texel_blocks.hpp"
#include "reconstruct/bricks/voxel_places.hpp"
#include "reconstruct/section/interpolation.hpp"
#include "reconstruct/section/pixel_grid.hpp"

namespace biotomy::reconstruct {

/// A piece of a picture, up to kMostPixels wide.
struct Tile {
  ColumnRange columns;
  int first_row = 0;
  int last_row = 0;  ///< the one after the last
};

/// The texels that a pixel is made of: along each axis from `below` before to `above` after the one
/// at the whole part of position + shift.
struct Support {
  int below = 0;
  int above = 0;
  double shift = 0.0;

  int width() const { return below + 1 + above; }
};
Support support_of(Interpolation kind);

/// What of a level the pixels of `grid` are made of.
PlaneReach plane_reach(const BrickSource& source, int level, const PixelGrid& grid,
                       Interpolation kind);

/// A row of the picture, or a piece of it, among the voxels of a level.
struct PictureRow {
  int row = 0;
  ColumnRange columns;               ///< that it fills: with background where it is not inside
  ColumnRange inside;                ///< of these, those in the cuboid
  ColumnRange ground;                ///< of these, those no deeper than the newest layer
  VoxelRow place;                    ///< in voxels of the level
  std::array<int, 3> border{};       ///< the last voxel, beyond which its colour goes on: x, y, z
  std::array<bool, 3> on_centres{};  ///< all pixels lie on voxel centres along this axis

  /// Whether the pixels lie along x from one voxel's centre to the next's.
  bool is_straight() const {
    return on_centres[0] && place.step == std::array<double, 3>{1.0, 0.0, 0.0};
  }

  PictureRow() = default;
  PictureRow(const BrickSource& source, int level, const PixelGrid& grid, int number);

  /// What of it lies in the columns of `part`.
  PictureRow piece(const ColumnRange& part) const;

  /// A position that does not change along the row and is off the border is on it from now on.
  void set_border(const std::array<int, 3>& last);
};

/// The support of one pixel.
struct PixelSupport {
  std::array<int, 3> first{};   ///< voxel, x, y, z; also outside the volume
  std::array<float, 3> part{};  ///< the pixel's place between the middle voxels, below 1
};

/// How a tile will be sampled from one level: where its pixels lie, and which bricks they need.
/// Made without any brick, so that all that a part of the picture needs can be fetched at once.
class TilePlan {
 public:
  /// `rows` are those of the tile.
  TilePlan(const BrickSource& source, int level, Interpolation kind, const Tile& tile,
           std::span<const PictureRow> rows);

  const Tile& tile() const { return tile_; }
  const Support& support() const { return support_; }

  /// Pieces of the rows of the tile, one after the other: one that passes the newest face is parted
  /// there, so that a piece lies above it or below.
  const std::vector<PictureRow>& rows() const { return rows_; }

  /// The bricks that are needed, each once.
  const std::vector<ChunkIndex>& bricks() const { return bricks_; }

  /// All slots of the box of bricks around the tile; the place in bricks() of the one at a slot, −1
  /// where it is not needed.
  const std::vector<std::int32_t>& bricks_at() const { return bricks_at_; }

  /// For linear: the way of row `i` of rows() through the box.
  const RowPath& path(std::size_t i) const { return paths_[i]; }

  /// For nearest and cubic: one pixel's support, and where its voxels lie: x, y, z. The sum of the
  /// slots of a voxel's three places is its brick's slot, the sum of the offsets its place there.
  PixelSupport support_at(const PictureRow& row, int column) const;
  const std::array<VoxelPlaces, 3>& places() const { return places_; }

  const TexelBlocks& blocks() const { return blocks_; }

 private:
  void add_pieces(const PictureRow& row, const std::array<int, 3>& newest);
  void set_box(Interpolation kind);
  RowPath path_of(const PictureRow& row) const;
  void need_linear();
  void need(const SupportBricks& bricks);
  void need_supports(const PictureRow& row);
  void need(int x, int y, int z);
  int brick_of(const PictureRow& row, std::size_t axis, int voxel) const;

  Tile tile_;
  Support support_;
  TexelBlocks blocks_;
  std::array<int, 3> shape_{};  // of a brick: x, y, z
  std::array<int, 3> last_{};   // voxel of the level
  std::array<VoxelPlaces, 3> places_;
  std::array<int, 3> first_brick_{};
  std::array<int, 3> brick_count_{};
  std::vector<std::int32_t> bricks_at_;
  std::vector<ChunkIndex> bricks_;
  std::vector<PictureRow> rows_;
  std::vector<RowPath> paths_;
};

}  // namespace biotomy::reconstruct
