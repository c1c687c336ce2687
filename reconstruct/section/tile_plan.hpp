#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "reconstruct/section/brick_source.hpp"
#include "reconstruct/section/interpolation.hpp"
#include "reconstruct/section/pixel_grid.hpp"
#include "reconstruct/section/texel_blocks.hpp"
#include "reconstruct/section/voxel_places.hpp"

namespace biotomy::reconstruct {

/// A piece of a picture.
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

/// Neighbouring pixels of a row, to be mixed linearly, whose whole support lies in one brick, or,
/// where the row stays between two layers, in one and the one below it.
struct PlannedRun {
  int column = 0;
  int count = 0;
  int brick = 0;              ///< place in TilePlan::bricks()
  int lower_brick = 0;        ///< that holds the layer after the pixels'
  std::array<int, 3> base{};  ///< texel of the brick, x, y, z, from which positions are counted
  int lower_z = 0;            ///< the layer of the lower brick
  std::array<std::uint32_t, 3> start{};  ///< in fixed point, from `base`
};

/// A pixel whose texels are gathered one by one: its support lies in several bricks, or beyond the
/// border of the volume, where the border's texels go on; or it is not mixed linearly.
struct PlannedPatch {
  int column = 0;
  std::array<int, 3> first{};   ///< voxel of the support, x, y, z; also outside the volume
  std::array<float, 3> part{};  ///< the pixel's place between the middle voxels, below 1
};

/// A row of the picture among the voxels of a level.
struct PictureRow {
  int row = 0;
  ColumnRange inside;                  ///< columns in the cuboid
  VoxelRow place;                      ///< in voxels of the level
  std::array<bool, 3> on_centres{};    ///< all pixels lie on voxel centres along this axis
  std::array<std::int32_t, 3> step{};  ///< in fixed point
  bool one_layer = false;              ///< the row stays between two layers
  int longest_run = 1;                 ///< pixels until rounded steps add up to a level

  PictureRow() = default;
  PictureRow(const BrickSource& source, int level, const PixelGrid& grid, int number);
};

/// The part of a row that lies in a tile, its pixels in runs and patches.
struct PlannedRow : PictureRow {
  bool crosses = false;  ///< the layer after the pixels' is in the bricks below
  std::size_t first_run = 0;
  std::size_t last_run = 0;
  std::size_t first_patch = 0;
  std::size_t last_patch = 0;
};

/// How a tile will be sampled from one level: which bricks it needs, and which pixels can be read
/// straight through a brick. Made without any brick, so that all that a part of the picture needs
/// can be fetched at once.
class TilePlan {
 public:
  /// `rows` are those of the tile.
  TilePlan(const BrickSource& source, int level, Interpolation kind, const Tile& tile,
           std::span<const PictureRow> rows);

  const Tile& tile() const { return tile_; }
  const Support& support() const { return support_; }
  const std::vector<PlannedRow>& rows() const { return rows_; }
  const std::vector<PlannedRun>& runs() const { return runs_; }
  const std::vector<PlannedPatch>& patches() const { return patches_; }

  /// The bricks that are needed, each once.
  const std::vector<ChunkIndex>& bricks() const { return bricks_; }

  /// Where the voxels around the tile lie: x, y, z. The sum of the slots of a voxel's three places
  /// is its brick's slot.
  const std::array<VoxelPlaces, 3>& places() const { return places_; }

  /// The place in bricks() of the one at a slot.
  int brick_at(int slot) const { return bricks_at_[static_cast<std::size_t>(slot)]; }

  const TexelBlocks& blocks() const { return blocks_; }

 private:
  class Walk;

  void set_places();
  void plan_row(PlannedRow& row);
  PlannedRun run_of(const PlannedRow& row, const std::array<Walk, 3>& walks, int column, int end);
  PlannedPatch patch_of(const PlannedRow& row, int column);
  int need(int slot);

  Tile tile_;
  Support support_;
  bool linear_;
  TexelBlocks blocks_;
  std::array<int, 3> shape_{};
  std::array<int, 3> last_{};  // voxel of the level
  std::array<VoxelPlaces, 3> places_;
  std::array<int, 3> first_brick_{};
  std::array<int, 3> brick_count_{};
  std::vector<int> bricks_at_;  // by slot; −1: not needed
  std::vector<ChunkIndex> bricks_;
  std::vector<PlannedRow> rows_;
  std::vector<PlannedRun> runs_;
  std::vector<PlannedPatch> patches_;
};

}  // namespace biotomy::reconstruct
