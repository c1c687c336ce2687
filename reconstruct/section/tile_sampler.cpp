#include "reconstruct/section/tile_sampler.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace biotomy::reconstruct {
namespace {

constexpr std::size_t kPixelLevels = 4;
constexpr std::size_t kVectorBytes = 64;
constexpr std::size_t kPixelsOfALine = 2;  // at least: a line holds a block of 4 × 4 texels

template <typename Level>
void paint(Level* rgb, int count, const std::array<Level, 3>& colour) {
  for (int i = 0; i < count; ++i, rgb += 3) {
    std::copy(colour.begin(), colour.end(), rgb);
  }
}

TexelRun texel_run(const TexelBlocks& blocks, const PlannedRow& row, const PlannedRun& run,
                   const std::byte* upper, const std::byte* lower) {
  const std::ptrdiff_t in_layer = blocks.along_x(run.base[0]) + blocks.along_y(run.base[1]);
  return {upper + in_layer + blocks.along_z(run.base[2]),
          lower + in_layer + blocks.along_z(run.lower_z),
          blocks.block_row_bytes(),
          blocks.layer_bytes(),
          row.on_centres[1] ? 0 : 1,
          run.start,
          row.step,
          run.count};
}

std::size_t inside_count(const PlannedRow& row) {
  return static_cast<std::size_t>(row.inside.last - row.inside.first);
}

}  // namespace

template <typename Level>
const std::byte* TileSampler<Level>::brick(int place) const {
  const std::byte* texels = bricks_[static_cast<std::size_t>(place)];
  return texels != nullptr ? texels : fill_value_.data();
}

// While a row is sampled the memory of the next is on its way.
template <typename Level>
void TileSampler<Level>::fill(const TilePlan& plan, std::span<const std::byte* const> bricks,
                              const std::array<Level, 3>& background, int first_row,
                              cv::Mat& picture) {
  bricks_ = bricks;
  const std::size_t brick_bytes = plan.blocks().brick_bytes() + TexelBlocks::slack();
  if (fill_value_.size() < brick_bytes &&
      std::find(bricks.begin(), bricks.end(), nullptr) != bricks.end()) {
    fill_value_.resize(brick_bytes);
  }
  const ColumnRange columns = plan.tile().columns;
  const auto width = static_cast<std::size_t>(columns.last - columns.first);
  row_.resize(kPixelLevels * (width + kRoomPixels));
  for (RowPlaces& places : places_) {
    places.runs.resize(width);
  }
  const std::vector<PlannedRow>& rows = plan.rows();
  for (std::size_t i = 0; i <= rows.size(); ++i) {
    if (i < rows.size()) {
      place_row(plan, rows[i], places_[i % 2]);
    }
    if (i == 0) {
      continue;
    }
    const PlannedRow& row = rows[i - 1];
    sample_row(plan, row, places_[(i - 1) % 2]);
    auto* out = picture.ptr<Level>(row.row - first_row);
    paint(out + 3 * std::ptrdiff_t{columns.first}, row.inside.first - columns.first, background);
    pack_pixels(
        row_.data() + kPixelLevels * static_cast<std::size_t>(row.inside.first - columns.first),
        inside_count(row), out + 3 * std::ptrdiff_t{row.inside.first});
    paint(out + 3 * std::ptrdiff_t{row.inside.last}, columns.last - row.inside.last, background);
  }
}

template <typename Level>
void TileSampler<Level>::place_row(const TilePlan& plan, const PlannedRow& row,
                                   RowPlaces& places) const {
  if (row.first_run != row.last_run) {
    place_runs(plan, row, places.runs);
  }
  switch (kind_) {
    case Interpolation::nearest:
      place_patches<1>(plan, row, places.texels);
      break;
    case Interpolation::linear:
      place_patches<2>(plan, row, places.texels);
      break;
    case Interpolation::cubic:
      place_patches<4>(plan, row, places.texels);
      break;
  }
}

template <typename Level>
void TileSampler<Level>::place_runs(const TilePlan& plan, const PlannedRow& row,
                                    PixelPlaces<Level>& places) const {
  places.crosses = row.crosses;
  places.down = row.on_centres[2] ? 0 : plan.blocks().layer_bytes();
  for (std::size_t i = row.first_run; i < row.last_run; ++i) {
    const PlannedRun& run = plan.runs()[i];
    place_run(texel_run(plan.blocks(), row, run, brick(run.brick), brick(run.lower_brick)), places,
              static_cast<std::size_t>(run.column - row.inside.first));
  }
  // Patches are mixed along with everything, at a place where there is something, and then
  // overwritten; likewise what lies behind the row's end.
  const auto anywhere =
      static_cast<std::size_t>(plan.runs()[row.first_run].column - row.inside.first);
  const auto stand_in = [&](std::size_t pixel) {
    for (std::size_t i = 0; i < 2; ++i) {
      places.upper[i][pixel] = places.upper[i][anywhere];
      places.lower[i][pixel] = places.lower[i][anywhere];
    }
  };
  for (std::size_t i = row.first_patch; i < row.last_patch; ++i) {
    stand_in(static_cast<std::size_t>(plan.patches()[i].column - row.inside.first));
  }
  for (std::size_t i = 0; i < kRoomPixels; ++i) {
    stand_in(inside_count(row) + i);
  }
  // The lines of memory that the pixels lie in are asked for now, so that they are there when it is
  // the row's turn: a section has no pattern that the processor could foresee. (Not in a function
  // of its own, which GCC would take for one without an effect.)
  for (std::size_t i = 0; i < inside_count(row); i += kPixelsOfALine) {
    for (std::size_t j = 0; j < 2; ++j) {
      const std::byte* upper = places.upper[j][i];
      __builtin_prefetch(upper);
      __builtin_prefetch(places.crosses ? places.lower[j][i] : upper + places.down);
    }
  }
}

/// The texels of each patch's support, x fastest, then y, then z.
template <typename Level>
template <int width>
void TileSampler<Level>::place_patches(const TilePlan& plan, const PlannedRow& row,
                                       std::vector<const std::byte*>& texels) const {
  constexpr std::size_t kTexels = std::size_t{width} * width * width;
  texels.resize((row.last_patch - row.first_patch) * kTexels);
  const std::byte** out = texels.data();
  for (std::size_t i = row.first_patch; i < row.last_patch; ++i) {
    const PlannedPatch& patch = plan.patches()[i];
    std::array<std::array<VoxelPlaces::Place, width>, 3> support;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (int j = 0; j < width; ++j) {
        const int voxel = patch.first[axis] + (row.on_centres[axis] ? plan.support().below : j);
        support[axis][static_cast<std::size_t>(j)] = plan.places()[axis].of(voxel);
      }
    }
    for (const VoxelPlaces::Place& z : support[2]) {
      for (const VoxelPlaces::Place& y : support[1]) {
        for (const VoxelPlaces::Place& x : support[0]) {
          *out = brick(plan.brick_at(x.slot + y.slot + z.slot)) + (x.offset + y.offset + z.offset);
          __builtin_prefetch(*out++);
        }
      }
    }
  }
}

template <typename Level>
void TileSampler<Level>::sample_row(const TilePlan& plan, const PlannedRow& row,
                                    const RowPlaces& places) {
  if (row.first_run != row.last_run) {
    const auto first = static_cast<std::size_t>(row.inside.first - plan.tile().columns.first);
    mix_linear(places.runs, inside_count(row), row_.data() + kPixelLevels * first);
  }
  if (row.first_patch == row.last_patch) {
    return;
  }
  if (kind_ == Interpolation::linear) {
    mix_patches(plan, row, places.texels);
    return;
  }
  constexpr std::size_t kCubicTexels = 64;
  std::array<Level, kCubicTexels * kPixelLevels> support{};
  const std::byte* const* texel = places.texels.data();
  for (std::size_t i = row.first_patch; i < row.last_patch; ++i) {
    const PlannedPatch& patch = plan.patches()[i];
    if (kind_ == Interpolation::nearest) {
      std::memcpy(pixel_of(plan, patch), *texel++, 3 * sizeof(Level));
      continue;
    }
    for (std::size_t j = 0; j < kCubicTexels; ++j) {
      std::memcpy(support.data() + kPixelLevels * j, *texel++, 3 * sizeof(Level));
    }
    mix_cubic(support.data(), patch.part, pixel_of(plan, patch));
  }
}

template <typename Level>
Level* TileSampler<Level>::pixel_of(const TilePlan& plan, const PlannedPatch& patch) {
  return row_.data() +
         kPixelLevels * static_cast<std::size_t>(patch.column - plan.tile().columns.first);
}

// The texels of all of a row's patches are gathered as the kernel wants to find them, and mixed at
// once.
template <typename Level>
void TileSampler<Level>::mix_patches(const TilePlan& plan, const PlannedRow& row,
                                     const std::vector<const std::byte*>& texels) {
  constexpr std::size_t kTexels = 8;
  constexpr std::size_t kTexel = 3 * sizeof(Level);
  constexpr std::size_t kPair = 8 * sizeof(Level);
  constexpr std::size_t kPatch = 4 * kPair;
  const std::size_t count = row.last_patch - row.first_patch;
  gathered_.resize(count * kPatch + kVectorBytes);
  mixed_.resize(kPixelLevels * (count + kRoomPixels));
  patch_places_.resize(count);
  patch_places_.down = 2 * kPair;
  for (std::size_t i = 0; i < count + kRoomPixels; ++i) {
    const std::size_t each = std::min(i, count - 1);  // behind the last: again
    std::byte* const support = gathered_.data() + each * kPatch;
    patch_places_.upper[0][i] = support;
    patch_places_.upper[1][i] = support + kPair;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const PlannedPatch& patch = plan.patches()[row.first_patch + i];
    std::byte* const support = gathered_.data() + i * kPatch;
    for (std::size_t corner = 0; corner < kTexels; ++corner) {
      std::memcpy(support + corner / 2 * kPair + corner % 2 * kTexel, texels[i * kTexels + corner],
                  kTexel);
    }
    patch_places_.x[i] = PixelPlaces<Level>::part(patch.part[0]);
    patch_places_.y[i] = PixelPlaces<Level>::part(patch.part[1]);
    patch_places_.z[i] = PixelPlaces<Level>::part(patch.part[2]);
  }
  mix_linear(patch_places_, count, mixed_.data());
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(pixel_of(plan, plan.patches()[row.first_patch + i]),
                mixed_.data() + kPixelLevels * i, kPixelLevels * sizeof(Level));
  }
}

template class TileSampler<std::uint8_t>;
template class TileSampler<std::uint16_t>;

}  // namespace biotomy::reconstruct
