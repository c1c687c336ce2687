#include "reconstruct/bricks/brick_cells.hpp"

#include <algorithm>
#include <cmath>

namespace biotomy::reconstruct {
namespace {

constexpr double kRounding = 1e-3;  // voxels; places are in fixed point

int round_up(int size, int unit) {
  return (size + unit - 1) / unit * unit;
}

/// `f(x, y, z)` for the numbers of each cell, in the order of their bits.
template <typename F>
void for_each_cell(F&& f) {
  for (int z = 0; z < BrickCells::kAlongAxis; ++z) {
    for (int y = 0; y < BrickCells::kAlongAxis; ++y) {
      for (int x = 0; x < BrickCells::kAlongAxis; ++x) {
        f(std::array<int, 3>{x, y, z});
      }
    }
  }
}

}  // namespace

BrickCells::BrickCells(const std::array<int, 3>& shape) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int size = shape[2 - axis];
    const int side = axis == 2
                         ? layers_of_a_block(shape[0])
                         : round_up(round_up(size, kAlongAxis) / kAlongAxis, TexelBlocks::kSide);
    for (int number = 0; number < kAlongAxis; ++number) {
      stretches_[axis][static_cast<std::size_t>(number)] = {std::min(number * side, size),
                                                            std::min((number + 1) * side, size)};
    }
  }
  for_each_cell([&](const std::array<int, 3>& cell) {
    bool is_there = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Stretch texels = stretch(axis, cell[axis]);
      is_there = is_there && texels.first < texels.end;
    }
    all_ |= is_there ? bit(cell[0], cell[1], cell[2]) : 0;
  });
}

ChunkLayers BrickCells::layers(CellSet cells) const {
  constexpr CellSet kLayer = (CellSet{1} << (kAlongAxis * kAlongAxis)) - 1;
  ChunkLayers layers{0, 0};
  for (int z = 0; z < kAlongAxis; ++z) {
    if ((cells >> (z * kAlongAxis * kAlongAxis) & kLayer) != 0) {
      const Stretch texels = stretch(2, z);
      layers.first = layers.end == 0 ? texels.first : layers.first;
      layers.end = texels.end;
    }
  }
  return layers;
}

CellsNearPlane::CellsNearPlane(const BrickCells& cells, const std::array<int, 3>& shape,
                               const PlaneReach& plane)
    : offset_(plane.offset), all_(cells.all()) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    brick_step_[axis] = plane.normal[axis] * shape[2 - axis];
  }
  std::size_t number = 0;
  for_each_cell([&](const std::array<int, 3>& cell) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const BrickCells::Stretch texels = cells.stretch(axis, cell[axis]);
      const double half = 0.5 * (texels.end - 1 - texels.first);
      middle_[number] += plane.normal[axis] * (texels.first + half);
      reach_[number] += std::abs(plane.normal[axis]) * (half + plane.reach + kRounding);
    }
    ++number;
  });
}

CellSet CellsNearPlane::of(ChunkIndex brick) const {
  const double place =
      brick_step_[0] * brick.x + brick_step_[1] * brick.y + brick_step_[2] * brick.z - offset_;
  CellSet cells = 0;
  for (std::size_t i = 0; i < BrickCells::kCells; ++i) {
    cells |= static_cast<CellSet>(std::abs(middle_[i] + place) <= reach_[i]) << i;
  }
  return cells & all_;
}

}  // namespace biotomy::reconstruct
