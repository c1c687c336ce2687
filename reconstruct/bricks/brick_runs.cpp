#include "reconstruct/bricks/brick_runs.hpp"

#include <cmath>
#include <limits>

namespace biotomy::reconstruct {
namespace {

constexpr double kUnit = 1U << kFractionBits;

int voxel_at(const RowAxis& axis, int pixel) {
  return axis.base + ((axis.start + pixel * axis.step) >> kFractionBits);
}

/// Voxels from `low` to before `high` with the same bricks.
struct Zone {
  BrickPair bricks;
  bool beyond_border = false;  ///< of the voxel or of the next
  int low = std::numeric_limits<int>::min();
  int high = std::numeric_limits<int>::max();
};

Zone zone_of(const RowAxis& axis, int voxel) {
  const auto same = [&](int inside) { return BrickPair{inside / axis.side, inside / axis.side}; };
  const int mixed = axis.last - axis.next;  // the last voxel that has the one that it wants
  Zone zone;
  if (voxel < axis.first) {
    zone = {same(axis.first), true};
    zone.high = axis.first;
    return zone;
  }
  if (voxel > mixed) {
    zone = {same(axis.last), true};
    zone.low = mixed + 1;
    return zone;
  }
  zone.bricks = same(voxel);
  zone.low = zone.bricks.near * axis.side;
  zone.high = zone.low + axis.side;
  if (axis.next != 0 && voxel == zone.high - 1) {
    ++zone.bricks.far;
    zone.low = voxel;
  } else {
    zone.high -= axis.next;
  }
  zone.low = std::max(zone.low, axis.first);
  zone.high = std::min(zone.high, mixed + 1);
  return zone;
}

/// The first pixel whose voxel is `voxel` or further along the row. The quotient of numbers of less
/// than 32 bits is far enough from the whole numbers that it does not equal for rounding not to
/// matter.
int first_pixel_at(const RowAxis& axis, double voxel) {
  const double way = (voxel - axis.base) * kUnit - axis.start + (axis.step > 0 ? 0.0 : kUnit - 1.0);
  return static_cast<int>(std::ceil(way / axis.step));
}

}  // namespace

void RunFinder::find_along(const RowAxis& axis, int count, std::vector<Stretch>& stretches) {
  stretches.clear();
  const int last = voxel_at(axis, count - 1);
  Zone zone = zone_of(axis, voxel_at(axis, 0));
  // That a zone's end is not waited for to find the next lets the processor do both at once.
  for (int end = 0; last < zone.low || last >= zone.high;) {
    const int voxel = axis.step > 0 ? zone.high : zone.low - 1;
    const int next = first_pixel_at(axis, voxel);
    if (next > end) {  // else the row steps over the zone
      stretches.push_back({next, zone.bricks, zone.beyond_border});
      end = next;
    }
    zone = zone_of(axis, voxel);
  }
  stretches.push_back({count, zone.bricks, zone.beyond_border});
}

void RunFinder::find(const RowPath& path, int count, std::vector<BrickRun>& runs) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    find_along(path.axes[axis], count, stretches_[axis]);
  }
  const bool stays_in_a_layer = path.axes[2].step == 0;
  const Stretch* x = stretches_[0].data();
  const Stretch* y = stretches_[1].data();
  const Stretch* z = stretches_[2].data();
  for (int pixel = 0; pixel < count;) {
    const int end = std::min({x->end, y->end, z->end});
    const bool parted = x->beyond_border || y->beyond_border || z->beyond_border ||
                        x->bricks.near != x->bricks.far ||
                        (!stays_in_a_layer && z->bricks.near != z->bricks.far);
    runs.push_back({pixel, end, {x->bricks, y->bricks, z->bricks}, parted});
    x += x->end == end ? 1 : 0;
    y += y->end == end ? 1 : 0;
    z += z->end == end ? 1 : 0;
    pixel = end;
  }
}

}  // namespace biotomy::reconstruct
