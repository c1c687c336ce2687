#include "reconstruct/section/tile_plan.hpp"

#include <algorithm>
#include <cmath>

#include "reconstruct/bricks/texel_kernels.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr double kUnit = static_cast<double>(1U << kFractionBits);
constexpr float kBelowOne = 0x1.fffffep-1F;

std::array<int, 3> last_voxel(const PyramidLevel& level) {
  return {static_cast<int>(level.size.x - 1), static_cast<int>(level.size.y - 1),
          static_cast<int>(level.size.z - 1)};
}

/// The layers that are ground. Where there is none all is black, the first layer too: it may be
/// taken for one.
std::int64_t ground_layers(const BrickSource& source) {
  return std::max(source.layers_present(), std::int64_t{1});
}

/// The last voxel of a level that a ground layer has a part in. Its centre lies up to half a voxel
/// before the newest face: mixed with the next, the face would be darkened by what is not ground.
std::array<int, 3> newest_voxel(const BrickSource& source, int number) {
  const PyramidLevel& level = source.level(number);
  std::array<int, 3> newest = last_voxel(level);
  newest[2] = static_cast<int>((ground_layers(source) - 1) / level.factor.z);
  return newest;
}

ColumnRange common(const ColumnRange& a, const ColumnRange& b) {
  const int first = std::clamp(a.first, b.first, b.last);
  return {first, std::clamp(a.last, first, b.last)};
}

bool is_whole(double number) {
  return number == std::floor(number);
}

}  // namespace

PictureRow::PictureRow(const BrickSource& source, int level, const PixelGrid& grid, int number)
    : row(number), columns{0, grid.columns}, place(voxel_row(grid, source.level(level), number)) {
  const VoxelRow in_cuboid = voxel_row(grid, source.cuboid(), number);
  GridSize size = source.cuboid().size;
  inside = columns_inside(in_cuboid, columns, size);
  size.z = ground_layers(source);
  ground = columns_inside(in_cuboid, inside, size);
  set_border(last_voxel(source.level(level)));
}

PictureRow PictureRow::piece(const ColumnRange& part) const {
  PictureRow result = *this;
  result.columns = common(columns, part);
  result.inside = common(inside, part);
  result.ground = common(ground, part);
  return result;
}

void PictureRow::set_border(const std::array<int, 3>& last) {
  border = last;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (place.step[axis] == 0.0) {
      place.start[axis] = std::clamp(place.start[axis], 0.0, static_cast<double>(border[axis]));
    }
    on_centres[axis] = is_whole(place.start[axis]) && is_whole(place.step[axis]);
  }
}

Support support_of(Interpolation kind) {
  switch (kind) {
    case Interpolation::nearest:
      return {0, 0, 0.5};
    case Interpolation::linear:
      return {0, 1, 0.0};
    case Interpolation::cubic:
      break;
  }
  return {1, 2, 0.0};
}

// A texel of the support is up to its shift, or the texels above, away from the pixel; which may
// have been moved to the border, or from the newest face to the last voxel that has a part of it,
// from up to half a voxel beyond, in a coarser level.
PlaneReach plane_reach(const BrickSource& source, int level, const PixelGrid& grid,
                       Interpolation kind) {
  constexpr double kBeyondBorder = 0.5;
  const VoxelRow first = voxel_row(grid, source.level(level), 0);
  const VoxelRow next = voxel_row(grid, source.level(level), 1);
  const Support support = support_of(kind);
  PlaneReach plane;
  plane.reach = support.shift + support.above + (level > 0 ? kBeyondBorder : 0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t i = (axis + 1) % 3;
    const std::size_t j = (axis + 2) % 3;
    plane.normal[axis] = first.step[i] * (next.start[j] - first.start[j]) -
                         first.step[j] * (next.start[i] - first.start[i]);
    plane.offset += plane.normal[axis] * first.start[axis];
  }
  return plane;
}

TilePlan::TilePlan(const BrickSource& source, int level, Interpolation kind, const Tile& tile,
                   std::span<const PictureRow> rows)
    : tile_(tile),
      support_(support_of(kind)),
      blocks_(source.brick_shape(), source.bits()),
      shape_{source.brick_shape()[2], source.brick_shape()[1], source.brick_shape()[0]},
      last_(last_voxel(source.level(level))) {
  const std::array<int, 3> newest = newest_voxel(source, level);
  rows_.reserve(rows.size());
  for (const PictureRow& row : rows) {
    add_pieces(row.piece(tile.columns), newest);
  }
  set_box(kind);
  if (kind == Interpolation::linear) {
    need_linear();
    return;
  }
  for (const PictureRow& row : rows_) {
    if (row.inside.first < row.inside.last) {
      need_supports(row);
    }
  }
}

// The row's pixels above the newest face are those from one of its ends on.
void TilePlan::add_pieces(const PictureRow& row, const std::array<int, 3>& newest) {
  const int face = row.ground.first > row.inside.first ? row.ground.first : row.ground.last;
  const bool passes = row.inside.first < face && face < row.inside.last;
  const int end = passes ? face : row.columns.last;
  for (const ColumnRange& part :
       {ColumnRange{row.columns.first, end}, ColumnRange{end, row.columns.last}}) {
    if (part.first == part.last) {
      continue;
    }
    rows_.push_back(row.piece(part));
    PictureRow& piece = rows_.back();
    if (piece.ground.first < piece.ground.last) {
      piece.set_border(newest);
    }
  }
}

// The bricks around the tile's pixels and their support.
void TilePlan::set_box(Interpolation kind) {
  std::array<int, 3> low = last_;
  std::array<int, 3> high{};
  for (const PictureRow& row : rows_) {
    if (row.inside.first == row.inside.last) {
      continue;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double first = row.place.at(static_cast<int>(axis), row.inside.first);
      const double last = row.place.at(static_cast<int>(axis), row.inside.last - 1);
      const int least = static_cast<int>(std::floor(std::min(first, last)));
      const int most = static_cast<int>(std::floor(std::max(first, last)));
      low[axis] = std::min(low[axis], std::clamp(least, 0, row.border[axis]));
      high[axis] = std::max(high[axis], std::clamp(most, 0, row.border[axis]));
    }
  }
  const int margin = support_.width();
  int slots = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = std::min(low[axis], high[axis]) - margin;
    high[axis] += margin;
    first_brick_[axis] = std::max(low[axis], 0) / shape_[axis];
    brick_count_[axis] = std::min(high[axis], last_[axis]) / shape_[axis] - first_brick_[axis] + 1;
    if (kind != Interpolation::linear) {
      places_[axis] = VoxelPlaces(blocks_, axis, low[axis], high[axis], last_[axis] + 1,
                                  shape_[axis], first_brick_[axis], slots);
    }
    slots *= brick_count_[axis];
  }
  bricks_at_.assign(static_cast<std::size_t>(slots), -1);
}

RowPath TilePlan::path_of(const PictureRow& row) const {
  RowPath path;
  path.block_row_bytes = blocks_.block_row_bytes();
  path.layer_bytes = blocks_.layer_bytes();
  int slot_stride = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double first = row.place.at(static_cast<int>(axis), row.inside.first);
    const double last = row.place.at(static_cast<int>(axis), row.inside.last - 1);
    const double base = std::floor(std::min(first, last));
    const int box_voxel = first_brick_[axis] * shape_[axis];
    const double step = std::abs(row.place.step[axis]) < kMostVoxels ? row.place.step[axis] : 0.0;
    path.axes[axis] = {static_cast<std::int32_t>((first - base) * kUnit),
                       static_cast<std::int32_t>(std::lround(step * kUnit)),
                       static_cast<int>(base) - box_voxel,
                       row.border[axis] - box_voxel,
                       -box_voxel,
                       shape_[axis],
                       slot_stride,
                       row.on_centres[axis] ? 0 : 1};
    slot_stride *= brick_count_[axis];
  }
  return path;
}

void TilePlan::need(int x, int y, int z) {
  std::int32_t& place =
      bricks_at_[static_cast<std::size_t>((z * brick_count_[1] + y) * brick_count_[0] + x)];
  if (place < 0) {
    place = static_cast<std::int32_t>(bricks_.size());
    bricks_.push_back({first_brick_[2] + z, first_brick_[1] + y, first_brick_[0] + x});
  }
}

void TilePlan::need(const SupportBricks& bricks) {
  const int x = bricks.slot % brick_count_[0];
  const int y = bricks.slot / brick_count_[0] % brick_count_[1];
  const int z = bricks.slot / brick_count_[0] / brick_count_[1];
  for (unsigned corner = 0; corner <= bricks.further; ++corner) {
    if ((corner & ~bricks.further) == 0) {
      need(x + static_cast<int>(corner & 1U), y + static_cast<int>(corner >> 1U & 1U),
           z + static_cast<int>(corner >> 2U));
    }
  }
}

void TilePlan::need_linear() {
  paths_.reserve(rows_.size());
  std::vector<bool> seen(bricks_at_.size() << SupportBricks::kAxisBits);
  std::array<std::int32_t, kFoundRoom> found{};
  for (const PictureRow& row : rows_) {
    const int count = row.inside.last - row.inside.first;
    paths_.push_back(count > 0 ? path_of(row) : RowPath());
    const std::size_t total = count > 0 ? find_bricks(paths_.back(), count, found.data()) : 0;
    for (std::size_t i = 0; i < total; ++i) {
      const auto number = static_cast<std::size_t>(found[i]);
      if (!seen[number]) {
        seen[number] = true;
        need(SupportBricks::of(found[i]));
      }
    }
  }
}

void TilePlan::need_supports(const PictureRow& row) {
  using Range = std::array<int, 2>;  // of bricks along an axis
  std::array<Range, 3> before{{{-1, -1}, {-1, -1}, {-1, -1}}};
  for (int column = row.inside.first; column < row.inside.last; ++column) {
    const PixelSupport support = support_at(row, column);
    std::array<Range, 3> bricks{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int middle = support.first[axis] + support_.below;
      const bool mixes = !row.on_centres[axis];
      bricks[axis] = {brick_of(row, axis, mixes ? support.first[axis] : middle),
                      brick_of(row, axis, mixes ? middle + support_.above : middle)};
    }
    if (bricks == before) {
      continue;
    }
    before = bricks;
    const auto& [along_x, along_y, along_z] = bricks;
    for (int z = along_z[0]; z <= along_z[1]; ++z) {
      for (int y = along_y[0]; y <= along_y[1]; ++y) {
        for (int x = along_x[0]; x <= along_x[1]; ++x) {
          need(x, y, z);
        }
      }
    }
  }
}

/// Beyond the border: the border's.
int TilePlan::brick_of(const PictureRow& row, std::size_t axis, int voxel) const {
  return std::clamp(voxel, 0, row.border[axis]) / shape_[axis] - first_brick_[axis];
}

PixelSupport TilePlan::support_at(const PictureRow& row, int column) const {
  PixelSupport support;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double place = std::clamp(row.place.at(static_cast<int>(axis), column), 0.0,
                                    static_cast<double>(row.border[axis]));
    support.first[axis] =
        std::min(static_cast<int>(place + support_.shift), row.border[axis]) - support_.below;
    support.part[axis] = std::min(static_cast<float>(place - static_cast<int>(place)), kBelowOne);
  }
  return support;
}

}  // namespace biotomy::reconstruct
