#include "reconstruct/section/tile_sampler.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace biotomy::reconstruct {
namespace {

constexpr std::size_t kPixelLevels = 4;
constexpr std::size_t kVectorBytes = 64;
constexpr std::size_t kPixelsOfALine = 2;  // at least: a line of memory holds 4 × 4 texels

template <typename Level>
void paint(Level* rgb, int count, const std::array<Level, 3>& colour) {
  for (int i = 0; i < count; ++i, rgb += 3) {
    std::copy(colour.begin(), colour.end(), rgb);
  }
}

std::size_t inside_count(const PictureRow& row) {
  return static_cast<std::size_t>(row.inside.last - row.inside.first);
}

/// Whether the voxels after the pixels' along z are in the same brick as theirs all along the row.
bool stays_in_a_layer_of_bricks(const RowAxis& z) {
  if (z.step != 0) {
    return false;
  }
  const int voxel = z.base + (z.start >> kFractionBits);
  return voxel >= z.first && voxel < z.last && voxel % z.side + z.next < z.side;
}

}  // namespace

// While a row is sampled the memory of the next is on its way.
template <typename Level>
void TileSampler<Level>::fill(const TilePlan& plan, std::span<const std::byte* const> bricks,
                              const std::array<Level, 3>& background, int first_row,
                              cv::Mat& picture) {
  const std::size_t brick_bytes = plan.blocks().brick_bytes() + TexelBlocks::slack();
  if (fill_value_.size() < brick_bytes &&
      std::find(bricks.begin(), bricks.end(), nullptr) != bricks.end()) {
    fill_value_.resize(brick_bytes);
  }
  bricks_.assign(plan.bricks_at().size(), nullptr);
  for (std::size_t slot = 0; slot < bricks_.size(); ++slot) {
    const std::int32_t place = plan.bricks_at()[slot];
    if (place >= 0) {
      const std::byte* texels = bricks[static_cast<std::size_t>(place)];
      bricks_[slot] = texels != nullptr ? texels : fill_value_.data();
    }
  }
  const ColumnRange columns = plan.tile().columns;
  resize(static_cast<std::size_t>(columns.last - columns.first));
  const std::vector<PictureRow>& rows = plan.rows();
  for (std::size_t i = 0; i <= rows.size(); ++i) {
    if (i < rows.size()) {
      place_row(plan, rows[i], places_[i % 2]);
    }
    if (i == 0) {
      continue;
    }
    const PictureRow& row = rows[i - 1];
    sample_row(plan, row, places_[(i - 1) % 2]);
    auto* out = picture.ptr<Level>(row.row - first_row);
    paint(out + 3 * std::ptrdiff_t{columns.first}, row.inside.first - columns.first, background);
    pack_pixels(row_.data(), inside_count(row), out + 3 * std::ptrdiff_t{row.inside.first});
    paint(out + 3 * std::ptrdiff_t{row.inside.last}, columns.last - row.inside.last, background);
  }
}

template <typename Level>
void TileSampler<Level>::resize(std::size_t width) {
  row_.resize(kPixelLevels * (width + kRoomPixels));
  for (RowPlaces& places : places_) {
    places.pairs.resize(width);
  }
  for (std::size_t pair = 0; pair < row_texels_.slots.size(); ++pair) {
    row_texels_.slots[pair].resize(width + kRoomPixels);
    row_texels_.offsets[pair].resize(width + kRoomPixels);
  }
  row_texels_.parted.resize(width + kRoomPixels);
}

template <typename Level>
void TileSampler<Level>::place_row(const TilePlan& plan, const PictureRow& row, RowPlaces& places) {
  places.gathered.clear();
  if (inside_count(row) == 0) {
    return;
  }
  if (kind_ == Interpolation::linear) {
    place_pairs(plan, row, places);
    place_parted(plan, inside_count(row), places);
    return;
  }
  for (std::size_t i = 0; i < inside_count(row); ++i) {
    places.gathered.push_back(i);
  }
  if (kind_ == Interpolation::nearest) {
    place_supports<1>(plan, row, places);
  } else {
    place_supports<4>(plan, row, places);
  }
}

template <typename Level>
void TileSampler<Level>::place_pairs(const TilePlan& plan, const PictureRow& row,
                                     RowPlaces& places) {
  const std::size_t count = inside_count(row);
  const RowPath path = plan.path(row);
  PixelPlaces<Level>& pairs = places.pairs;
  pairs.crosses = !stays_in_a_layer_of_bricks(path.axes[2]);
  pairs.down = path.axes[2].next * std::ptrdiff_t{path.layer_bytes};
  reconstruct::place_row(path, count, row_texels_, pairs);
  const auto texel = [&](std::size_t pair, std::size_t i) {
    return bricks_[static_cast<std::size_t>(row_texels_.slots[pair][i])] +
           row_texels_.offsets[pair][i];
  };
  for (std::size_t i = 0; i < count + kRoomPixels; ++i) {
    const std::size_t pixel = std::min(i, count - 1);  // behind the last: again
    pairs.upper[0][i] = texel(0, pixel);
    pairs.upper[1][i] = texel(1, pixel);
  }
  if (pairs.crosses) {
    for (std::size_t i = 0; i < count + kRoomPixels; ++i) {
      const std::size_t pixel = std::min(i, count - 1);
      pairs.lower[0][i] = texel(2, pixel);
      pairs.lower[1][i] = texel(3, pixel);
    }
  }
  // The lines of memory that the pixels lie in are asked for now, so that they are there when it is
  // the row's turn: a section has no pattern that the processor could foresee. (Not in a function
  // of its own, which GCC would take for one without an effect.)
  for (std::size_t i = 0; i < count; i += kPixelsOfALine) {
    for (std::size_t j = 0; j < 2; ++j) {
      const std::byte* upper = pairs.upper[j][i];
      __builtin_prefetch(upper);
      __builtin_prefetch(pairs.crosses ? pairs.lower[j][i] : upper + pairs.down);
    }
  }
}

/// The texels of pixels whose left texel is the last of a brick's row and whose right one the first
/// of the next brick's, x fastest, then y, then z.
template <typename Level>
void TileSampler<Level>::place_parted(const TilePlan& plan, std::size_t count,
                                      RowPlaces& places) const {
  places.texels.clear();
  const std::ptrdiff_t row_of_brick = plan.blocks().along_x(plan.side_x() - 1);
  for (std::size_t i = 0; i < count; ++i) {
    if (row_texels_.parted[i] == 0) {
      continue;
    }
    places.gathered.push_back(i);
    for (std::size_t pair = 0; pair < 4; ++pair) {
      const bool below = pair >= 2 && !places.pairs.crosses;
      const auto slot = static_cast<std::size_t>(row_texels_.slots[below ? pair - 2 : pair][i]);
      const std::ptrdiff_t offset =
          row_texels_.offsets[below ? pair - 2 : pair][i] + (below ? places.pairs.down : 0);
      places.texels.push_back(bricks_[slot] + offset);
      places.texels.push_back(bricks_[slot + 1] + (offset - row_of_brick));
      __builtin_prefetch(places.texels.back());
    }
  }
}

/// The texels of each gathered pixel's support, x fastest, then y, then z.
template <typename Level>
template <int width>
void TileSampler<Level>::place_supports(const TilePlan& plan, const PictureRow& row,
                                        RowPlaces& places) const {
  constexpr std::size_t kTexels = std::size_t{width} * width * width;
  places.texels.resize(places.gathered.size() * kTexels);
  const std::byte** out = places.texels.data();
  for (const std::size_t pixel : places.gathered) {
    const PixelSupport at = plan.support_at(row, row.inside.first + static_cast<int>(pixel));
    std::array<std::array<VoxelPlaces::Place, width>, 3> support;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (int j = 0; j < width; ++j) {
        const int voxel = at.first[axis] + (row.on_centres[axis] ? plan.support().below : j);
        support[axis][static_cast<std::size_t>(j)] = plan.places()[axis].of(voxel);
      }
    }
    for (const VoxelPlaces::Place& z : support[2]) {
      for (const VoxelPlaces::Place& y : support[1]) {
        for (const VoxelPlaces::Place& x : support[0]) {
          *out = bricks_[static_cast<std::size_t>(x.slot + y.slot + z.slot)] +
                 (x.offset + y.offset + z.offset);
          __builtin_prefetch(*out++);
        }
      }
    }
  }
}

template <typename Level>
void TileSampler<Level>::sample_row(const TilePlan& plan, const PictureRow& row,
                                    const RowPlaces& places) {
  if (inside_count(row) == 0) {
    return;
  }
  switch (kind_) {
    case Interpolation::nearest:
      take_nearest(places);
      break;
    case Interpolation::linear:
      mix_linear(places.pairs, inside_count(row), row_.data());
      if (!places.gathered.empty()) {
        mix_parted(places);
      }
      break;
    case Interpolation::cubic:
      mix_supports(plan, row, places);
      break;
  }
}

// The texels of all of a row's parted pixels are gathered as the kernel wants to find them, and
// mixed at once.
template <typename Level>
void TileSampler<Level>::mix_parted(const RowPlaces& places) {
  constexpr std::size_t kTexels = 8;
  constexpr std::size_t kTexel = 3 * sizeof(Level);
  constexpr std::size_t kPair = 8 * sizeof(Level);
  constexpr std::size_t kSupport = 4 * kPair;
  const std::size_t count = places.gathered.size();
  parted_texels_.resize(count * kSupport + kVectorBytes);
  parted_pixels_.resize(kPixelLevels * (count + kRoomPixels));
  parted_places_.resize(count);
  parted_places_.down = 2 * kPair;
  for (std::size_t i = 0; i < count + kRoomPixels; ++i) {
    std::byte* const support = parted_texels_.data() + std::min(i, count - 1) * kSupport;
    parted_places_.upper[0][i] = support;
    parted_places_.upper[1][i] = support + kPair;
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::byte* const support = parted_texels_.data() + i * kSupport;
    for (std::size_t corner = 0; corner < kTexels; ++corner) {
      std::memcpy(support + corner / 2 * kPair + corner % 2 * kTexel,
                  places.texels[i * kTexels + corner], kTexel);
    }
    const std::size_t pixel = places.gathered[i];
    parted_places_.x[i] = places.pairs.x[pixel];
    parted_places_.y[i] = places.pairs.y[pixel];
    parted_places_.z[i] = places.pairs.z[pixel];
  }
  mix_linear(parted_places_, count, parted_pixels_.data());
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(row_.data() + kPixelLevels * places.gathered[i],
                parted_pixels_.data() + kPixelLevels * i, kPixelLevels * sizeof(Level));
  }
}

template <typename Level>
void TileSampler<Level>::take_nearest(const RowPlaces& places) {
  for (std::size_t i = 0; i < places.gathered.size(); ++i) {
    std::memcpy(row_.data() + kPixelLevels * i, places.texels[i], 3 * sizeof(Level));
  }
}

template <typename Level>
void TileSampler<Level>::mix_supports(const TilePlan& plan, const PictureRow& row,
                                      const RowPlaces& places) {
  constexpr std::size_t kTexels = 64;
  std::array<Level, kTexels * kPixelLevels> support{};
  const std::byte* const* texel = places.texels.data();
  for (std::size_t i = 0; i < places.gathered.size(); ++i) {
    for (std::size_t j = 0; j < kTexels; ++j) {
      std::memcpy(support.data() + kPixelLevels * j, *texel++, 3 * sizeof(Level));
    }
    std::array<float, 3> part = plan.support_at(row, row.inside.first + static_cast<int>(i)).part;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      part[axis] = row.on_centres[axis] ? 0.0F : part[axis];
    }
    mix_cubic(support.data(), part, row_.data() + kPixelLevels * i);
  }
}

template class TileSampler<std::uint8_t>;
template class TileSampler<std::uint16_t>;

}  // namespace biotomy::reconstruct
