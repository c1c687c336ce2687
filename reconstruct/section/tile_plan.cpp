#include "reconstruct/section/tile_plan.hpp"

#include <algorithm>
#include <cmath>

#include "reconstruct/section/texel_kernels.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr double kUnit = static_cast<double>(1U << kFractionBits);
constexpr double kMostDrift = 0.9;  // levels: a run's last pixel against the exact one
constexpr int kMostTexels = kLongestBrickSide - 1;  // that a position can count
constexpr float kBelowOne = 0x1.fffffep-1F;
constexpr std::size_t kRunsOfARow = 12;  // of a usual tile, so that little has to grow

std::array<int, 3> last_voxel(const PyramidLevel& level) {
  return {static_cast<int>(level.size.x - 1), static_cast<int>(level.size.y - 1),
          static_cast<int>(level.size.z - 1)};
}

bool is_whole(double number) {
  return number == std::floor(number);
}

/// A position that does not change along the row and is off the border is on it: the border's
/// colour goes on there.
void keep_inside(VoxelRow& place, const std::array<int, 3>& last) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (place.step[axis] == 0.0) {
      place.start[axis] = std::clamp(place.start[axis], 0.0, static_cast<double>(last[axis]));
    }
  }
}

/// After how many pixels the rounding of a row's step to fixed point has added up to kMostDrift,
/// where neighbouring voxels are as different as they can be. With 8 bits no run is that long.
int pixels_to_drift(const VoxelRow& place, const std::array<std::int32_t, 3>& step, int bits) {
  double units = 0.0;  // a pixel
  for (std::size_t axis = 0; axis < 3; ++axis) {
    units += std::abs(place.step[axis] * kUnit - step[axis]);
  }
  const double levels = (1 << bits) - 1;
  const double start = 3.0;  // units, at most, by which the three starts are rounded
  const double pixels = (kMostDrift / levels * kUnit - start) / units;
  return pixels < kLongestRun ? std::max(static_cast<int>(pixels), 1) : kLongestRun;
}

/// Rounded up; of a number from 0 on, without the call of a function.
int ceiling(double number) {
  const int whole = static_cast<int>(number);
  return static_cast<double>(whole) < number ? whole + 1 : whole;
}

}  // namespace

PictureRow::PictureRow(const BrickSource& source, int level, const PixelGrid& grid, int number)
    : row(number),
      inside(columns_inside(voxel_row(grid, source.cuboid(), number), {0, grid.columns},
                            source.cuboid().size)),
      place(voxel_row(grid, source.level(level), number)) {
  keep_inside(place, last_voxel(source.level(level)));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    on_centres[axis] = is_whole(place.start[axis]) && is_whole(place.step[axis]);
    step[axis] = std::abs(place.step[axis]) < kMostTexels
                     ? static_cast<std::int32_t>(std::round(place.step[axis] * kUnit))
                     : 0;
  }
  one_layer = place.step[2] == 0.0;
  longest_run = pixels_to_drift(place, step, source.bits());
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

/// Follows a row along one axis: up to which column its pixels' support stays in one brick. Where
/// that is is told by floating point, where the kernels are by fixed point; at the seam they may
/// differ by a ten-thousandth of a voxel, so positions are kept on the brick's side of it.
class TilePlan::Walk {
 public:
  Walk() = default;
  Walk(const VoxelPlaces& places, const Support& support, const PlannedRow& row, std::size_t axis,
       int side, int last)
      : places_(&places),
        side_(side),
        last_(last),
        start_(row.place.start[axis] + support.shift),
        step_(row.place.step[axis]),
        inverse_step_(step_ != 0.0 ? 1.0 / step_ : 0.0) {
    if (!row.on_centres[axis]) {
      below_ = support.below;
      above_ = support.above;
    }
    if (axis == 2 && row.one_layer && last > 0) {
      may_cross_ = above_ == 1;
    }
  }

  /// Moves on to `column`, which is not before the one of the last call.
  void enter(int column) {
    if (column < until_) {
      return;
    }
    const double place = start_ + column * step_;
    const int voxel = static_cast<int>(place);  // the whole part where it matters: above 0
    until_ = column + 1;
    free_ = false;
    if (place < 0.0 || voxel > last_) {
      return;
    }
    const VoxelPlaces::Place& at = places_->of(voxel);
    slot_ = at.slot;
    origin_ = voxel - at.texel;
    const int low = origin_ + below_;
    const int high = may_cross_ ? std::min(origin_ + side_, last_)
                                : std::min(origin_ + side_, last_ + 1) - above_;
    if (voxel < low || voxel >= high) {
      return;
    }
    end_ = high - origin_;
    free_ = true;
    crosses_ = may_cross_ && voxel + 1 == origin_ + side_;
    if (step_ > 0.0) {
      until_ = std::max(until_, ceiling(std::min<double>((high - start_) * inverse_step_, kNever)));
    } else if (step_ < 0.0) {
      const double last_column = std::min<double>((low - start_) * inverse_step_, kNever);
      until_ = std::max(until_, static_cast<int>(last_column) + 1);
    } else {
      until_ = kNever;
    }
    if (std::abs(step_) >= kMostTexels) {
      until_ = column + 1;  // a step too large for fixed point
    }
  }

  bool free() const { return free_; }
  int until() const { return until_; }  ///< the first column to which this does not apply
  int slot() const { return slot_; }
  bool crosses() const { return crosses_; }  ///< the support ends in the brick after

  /// A texel from which positions in the brick can be counted at `column`: its first one, except in
  /// bricks with very long sides. And the position.
  int base(int column) const {
    const int texel = static_cast<int>(start_ + column * step_) - origin_;
    constexpr int kBlock = TexelBlocks::kSide;
    return side_ > kMostTexels ? std::max(0, texel - kMostTexels / 2) / kBlock * kBlock : 0;
  }
  std::uint32_t position(int column, int base) const {
    const auto place =
        static_cast<std::int64_t>((start_ + column * step_ - origin_ - base) * kUnit);
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(place, 0, positions_from(base) - 1));
  }
  /// How many of `count` pixels from a position on stay among the brick's. At most a last few
  /// don't.
  int kept(int count, std::uint32_t start, std::int32_t step, int base) const {
    const std::int64_t positions = positions_from(base);
    std::int64_t position = start + std::int64_t{count - 1} * step;
    for (; position < 0 || position >= positions; position -= step) {
      --count;  // not the first, which lies among them
    }
    return count;
  }
  /// How many columns from `column` on keep within what a position can count.
  int reach(int column, int base) const {
    if (side_ <= kMostTexels || step_ == 0.0) {
      return kNever;
    }
    const double texel = start_ + column * step_ - origin_ - base;
    const double room = step_ > 0.0 ? kMostTexels - 1 - texel : texel;
    return std::max(1, static_cast<int>(std::min<double>(room * std::abs(inverse_step_), kNever)));
  }

 private:
  static constexpr int kNever = 1 << 30;

  std::int64_t positions_from(int base) const { return std::int64_t{end_ - base} << kFractionBits; }

  const VoxelPlaces* places_ = nullptr;
  int side_ = 0;
  int last_ = 0;
  double start_ = 0.0;
  double step_ = 0.0;
  double inverse_step_ = 0.0;
  int below_ = 0;
  int above_ = 0;
  bool may_cross_ = false;

  int until_ = -1;
  bool free_ = false;
  bool crosses_ = false;
  int slot_ = 0;
  int origin_ = 0;
  int end_ = 0;  // the texel after those at which a support within the brick may be
};

TilePlan::TilePlan(const BrickSource& source, int level, Interpolation kind, const Tile& tile,
                   std::span<const PictureRow> rows)
    : tile_(tile),
      support_(support_of(kind)),
      linear_(kind == Interpolation::linear),
      blocks_(source.brick_shape(), source.bits()),
      shape_{source.brick_shape()[2], source.brick_shape()[1], source.brick_shape()[0]},
      last_(last_voxel(source.level(level))) {
  rows_.reserve(rows.size());
  runs_.reserve(kRunsOfARow * rows.size());
  patches_.reserve(kRunsOfARow * rows.size());
  for (const PictureRow& row : rows) {
    PlannedRow part{row};
    part.inside.first = std::clamp(row.inside.first, tile.columns.first, tile.columns.last);
    part.inside.last = std::clamp(row.inside.last, part.inside.first, tile.columns.last);
    rows_.push_back(part);
  }
  set_places();
  for (PlannedRow& row : rows_) {
    plan_row(row);
  }
}

// The bricks around the tile's pixels and their support.
void TilePlan::set_places() {
  std::array<int, 3> low = last_;
  std::array<int, 3> high{};
  for (const PlannedRow& row : rows_) {
    if (row.inside.first == row.inside.last) {
      continue;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double first = row.place.at(static_cast<int>(axis), row.inside.first);
      const double last = row.place.at(static_cast<int>(axis), row.inside.last - 1);
      const int least = static_cast<int>(std::floor(std::min(first, last)));
      const int most = static_cast<int>(std::floor(std::max(first, last)));
      low[axis] = std::min(low[axis], std::clamp(least, 0, last_[axis]));
      high[axis] = std::max(high[axis], std::clamp(most, 0, last_[axis]));
    }
  }
  const int margin = support_.width();
  int slots = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = std::min(low[axis], high[axis]) - margin;
    high[axis] += margin;
    first_brick_[axis] = std::max(low[axis], 0) / shape_[axis];
    brick_count_[axis] = std::min(high[axis], last_[axis]) / shape_[axis] - first_brick_[axis] + 1;
    places_[axis] = VoxelPlaces(blocks_, axis, low[axis], high[axis], last_[axis] + 1, shape_[axis],
                                first_brick_[axis], slots);
    slots *= brick_count_[axis];
  }
  bricks_at_.assign(static_cast<std::size_t>(slots), -1);
}

int TilePlan::need(int slot) {
  int& place = bricks_at_[static_cast<std::size_t>(slot)];
  if (place < 0) {
    place = static_cast<int>(bricks_.size());
    const int layer = brick_count_[0] * brick_count_[1];
    bricks_.push_back({first_brick_[2] + slot / layer,
                       first_brick_[1] + slot % layer / brick_count_[0],
                       first_brick_[0] + slot % brick_count_[0]});
  }
  return place;
}

void TilePlan::plan_row(PlannedRow& row) {
  std::array<Walk, 3> walks;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    walks[axis] = Walk(places_[axis], support_, row, axis, shape_[axis], last_[axis]);
  }
  auto& [x, y, z] = walks;
  row.first_run = runs_.size();
  row.first_patch = patches_.size();
  for (int column = row.inside.first; column < row.inside.last;) {
    if (!linear_) {
      patches_.push_back(patch_of(row, column++));
      continue;
    }
    x.enter(column);
    y.enter(column);
    z.enter(column);
    if (x.free() && y.free() && z.free()) {
      const int end = std::min({x.until(), y.until(), z.until(), row.inside.last});
      runs_.push_back(run_of(row, walks, column, end));
      column += runs_.back().count;
    } else {
      patches_.push_back(patch_of(row, column));
      ++column;
    }
  }
  row.crosses = z.crosses();
  row.last_run = runs_.size();
  row.last_patch = patches_.size();
}

PlannedRun TilePlan::run_of(const PlannedRow& row, const std::array<Walk, 3>& walks, int column,
                            int end) {
  PlannedRun run;
  run.column = column;
  run.count = std::min(end - column, row.longest_run);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    run.base[axis] = walks[axis].base(column);
    run.start[axis] = walks[axis].position(column, run.base[axis]);
    run.count = std::min(run.count, walks[axis].reach(column, run.base[axis]));
    run.count = walks[axis].kept(run.count, run.start[axis], row.step[axis], run.base[axis]);
  }
  const int slot = walks[0].slot() + walks[1].slot() + walks[2].slot();
  run.brick = need(slot);
  run.lower_brick = run.brick;
  if (row.one_layer) {
    // The layer goes into the base, so that the one below may be in another brick.
    run.base[2] += static_cast<int>(run.start[2] >> kFractionBits);
    run.start[2] &= (1U << kFractionBits) - 1;
    if (walks[2].crosses()) {
      run.lower_brick = need(slot + brick_count_[0] * brick_count_[1]);
      run.lower_z = 0;
      return run;
    }
  }
  run.lower_z = row.on_centres[2] ? run.base[2] : run.base[2] + 1;
  return run;
}

PlannedPatch TilePlan::patch_of(const PlannedRow& row, int column) {
  PlannedPatch patch;
  patch.column = column;
  std::array<int, 3> from{};
  std::array<int, 3> to{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double place = std::clamp(row.place.at(static_cast<int>(axis), column), 0.0,
                                    static_cast<double>(last_[axis]));
    const int middle = std::min(static_cast<int>(place + support_.shift), last_[axis]);
    patch.first[axis] = middle - support_.below;
    patch.part[axis] = std::min(static_cast<float>(place - static_cast<int>(place)), kBelowOne);
    const bool mixes = !row.on_centres[axis];
    from[axis] = places_[axis].of(mixes ? middle - support_.below : middle).slot;
    to[axis] = places_[axis].of(mixes ? middle + support_.above : middle).slot;
  }
  const int row_stride = brick_count_[0];
  const int layer_stride = brick_count_[0] * brick_count_[1];
  for (int z = from[2]; z <= to[2]; z += layer_stride) {
    for (int y = from[1]; y <= to[1]; y += row_stride) {
      for (int x = from[0]; x <= to[0]; ++x) {
        need(x + y + z);
      }
    }
  }
  return patch;
}

}  // namespace biotomy::reconstruct
