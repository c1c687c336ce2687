#include "reconstruct/section/tile_sampler.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace biotomy::reconstruct {
namespace {

constexpr std::size_t kPixelLevels = 4;
constexpr std::size_t kPairLevels = 8;  // two texels of three, and two that mean nothing
constexpr std::size_t kVectorBytes = 64;
constexpr std::size_t kPixelsOfALine = 2;  // at least: a line of memory holds 4 × 4 texels

std::size_t inside_count(const PictureRow& row) {
  return static_cast<std::size_t>(row.inside.last - row.inside.first);
}

/// The lines of memory that pixels lie in are asked for, so that they are there when it is the
/// pixels' turn: a section has no pattern that the processor could foresee. (A template, because
/// GCC takes a function that does nothing else for one without an effect.)
template <typename Level>
[[gnu::always_inline]] inline void prefetch(const PixelPlaces<Level>& pairs, std::size_t count) {
  for (std::size_t i = 0; i < count; i += kPixelsOfALine) {
    for (std::size_t j = 0; j < 2; ++j) {
      const std::byte* upper = pairs.upper[j][i];
      __builtin_prefetch(upper);
      __builtin_prefetch(pairs.crosses ? pairs.lower[j][i] : upper + pairs.down);
    }
  }
}

/// Where parted pixels' pairs of texels are gathered: in a layer a pixel's two, one behind the
/// other, and those of the layer below as many bytes behind them as the whole row's are.
template <typename Level>
class PartedPairs {
 public:
  static constexpr std::size_t kPair = kPairLevels * sizeof(Level);

  explicit PartedPairs(const PixelPlaces<Level>& row)
      : down_(row.crosses ? 2 * kPair : static_cast<std::size_t>(row.down)),
        in_a_band_(down_ == 0 ? kMostPixels : static_cast<unsigned>(down_ / (2 * kPair))) {}

  std::size_t down() const { return down_; }

  /// Of the upper pairs of a row's parted pixel.
  std::size_t place(unsigned number) const {
    const std::size_t band = number / in_a_band_;
    const std::size_t within = number % in_a_band_;
    return 2 * (band * down_ + within * kPair);
  }

  /// Room for the pairs of one pixel or more, and for a vector that begins with the last of them.
  std::size_t bytes(unsigned count) const {
    return place(count - 1) + down_ + kPair + kVectorBytes;
  }

 private:
  std::size_t down_;
  unsigned in_a_band_;  // of upper pairs, until the lower ones of the first begin
};

}  // namespace

template <typename Level>
TileSampler<Level>::TileSampler(Interpolation kind, const std::array<Level, 3>& background)
    : kind_(kind) {
  for (int i = 0; i < kMostPixels; ++i) {
    background_.insert(background_.end(), background.begin(), background.end());
  }
}

// While a row is sampled the memory of the next is on its way.
template <typename Level>
void TileSampler<Level>::fill(const TilePlan& plan, std::span<const std::byte* const> bricks,
                              int first_row, cv::Mat& picture) {
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
      place_row(plan, i, places_[i % 2]);
    }
    if (i == 0) {
      continue;
    }
    const PictureRow& row = rows[i - 1];
    auto* out = picture.ptr<Level>(row.row - first_row);
    paint(out + 3 * std::ptrdiff_t{columns.first}, row.inside.first - columns.first);
    if (inside_count(row) > 0) {
      sample_row(plan, row, places_[(i - 1) % 2], out + 3 * std::ptrdiff_t{row.inside.first});
    }
    paint(out + 3 * std::ptrdiff_t{row.inside.last}, columns.last - row.inside.last);
  }
}

template <typename Level>
void TileSampler<Level>::paint(Level* rgb, int count) const {
  std::copy_n(background_.begin(), 3 * count, rgb);
}

template <typename Level>
void TileSampler<Level>::resize(std::size_t width) {
  row_.resize(kPixelLevels * (width + kRoomPixels));
  for (RowPlaces& places : places_) {
    places.pairs.resize(width);
  }
}

template <typename Level>
void TileSampler<Level>::place_row(const TilePlan& plan, std::size_t number, RowPlaces& places) {
  const PictureRow& row = plan.rows()[number];
  if (inside_count(row) == 0) {
    return;
  }
  switch (kind_) {
    case Interpolation::nearest:
      place_supports<1>(plan, row, places);
      break;
    case Interpolation::linear:
      place_runs(plan, number, places);
      break;
    case Interpolation::cubic:
      place_supports<4>(plan, row, places);
      break;
  }
}

template <typename Level>
void TileSampler<Level>::place_runs(const TilePlan& plan, std::size_t number,
                                    RowPlaces& places) const {
  const RowPath& path = plan.path(number);
  const std::span<const BrickRun> runs = plan.runs(number);
  places.straight.clear();
  if (plan.rows()[number].is_straight() &&
      std::none_of(runs.begin(), runs.end(), [](const BrickRun& run) { return run.parted; })) {
    place_straight(plan, path, runs, places);
    return;
  }
  PixelPlaces<Level>& pairs = places.pairs;
  pairs.crosses =
      path.axes[2].step == 0 && runs.front().bricks[2].near != runs.front().bricks[2].far;
  pairs.down = path.axes[2].next * std::ptrdiff_t{path.layer_bytes};
  reconstruct::place_runs(path, runs, bricks_.data(), pairs);
  const auto count = static_cast<std::size_t>(runs.back().last);
  places.parted.clear();
  places.parted_pairs.resize(std::max(
      places.parted_pairs.size(), PartedPairs<Level>(pairs).bytes(static_cast<unsigned>(count))));
  for (const BrickRun& run : runs) {
    if (run.parted) {
      place_parted(plan, path, run, places);
    }
  }
  prefetch(pairs, count);
  // The kernels' vectors reach behind the last pixel: there stand places of texels.
  for (auto* texels : {&pairs.upper, &pairs.lower}) {
    for (auto& row : *texels) {
      std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(count), kRoomPixels, row[count - 1]);
    }
  }
}

/// Finds the texels of a run's pixels. In the row's places stands where they will be gathered.
template <typename Level>
void TileSampler<Level>::place_parted(const TilePlan& plan, const RowPath& path,
                                      const BrickRun& run, RowPlaces& places) const {
  const TexelBlocks& blocks = plan.blocks();
  const auto along = [&](std::size_t axis, int pixel) {
    const TexelPair texels = texel_pair(path.axes[axis], run.bricks[axis], pixel);
    return AxisPlaces{{blocks.along(axis, texels.near), blocks.along(axis, texels.far)},
                      PixelPlaces<Level>::part(texels.part)};
  };
  std::array<std::array<int, 2>, 3> slots{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const BrickPair& bricks = run.bricks[axis];
    const int stride = path.axes[axis].slot_stride;
    slots[axis] = {bricks.near * stride, bricks.far * stride};
  }
  PartedTexels bricks{};
  for (std::size_t corner = 0; corner < bricks.size(); ++corner) {
    bricks[corner] = bricks_[static_cast<std::size_t>(
        slots[0][corner % 2] + slots[1][corner / 2 % 2] + slots[2][corner / 4])];
  }
  PixelPlaces<Level>& pairs = places.pairs;
  const PartedPairs<Level> gathered(pairs);
  const bool stays_in_a_layer = path.axes[2].step == 0;
  AxisPlaces z = along(2, run.first);
  for (int pixel = run.first; pixel < run.last; ++pixel) {
    const AxisPlaces x = along(0, pixel);
    const AxisPlaces y = along(1, pixel);
    if (!stays_in_a_layer) {
      z = along(2, pixel);
    }
    const std::byte* const upper =
        places.parted_pairs.data() + gathered.place(static_cast<unsigned>(places.parted.size()));
    PartedTexels& texels = places.parted.emplace_back();
    for (std::size_t corner = 0; corner < texels.size(); ++corner) {
      texels[corner] = bricks[corner] +
                       (x.offsets[corner % 2] + y.offsets[corner / 2 % 2] + z.offsets[corner / 4]);
      __builtin_prefetch(texels[corner]);
    }
    const auto i = static_cast<std::size_t>(pixel);
    for (std::size_t row = 0; row < 2; ++row) {
      pairs.upper[row][i] = upper + row * gathered.kPair;
      if (pairs.crosses) {
        pairs.lower[row][i] = pairs.upper[row][i] + gathered.down();
      }
    }
    pairs.x[i] = x.part;
    pairs.y[i] = y.part;
    pairs.z[i] = z.part;
  }
}

/// As the kernel wants to find them. One level more than a texel's is copied, to have whole words:
/// the next copy overwrites it, or it means nothing.
template <typename Level>
void TileSampler<Level>::gather_parted(RowPlaces& places) {
  constexpr std::size_t kTexelLevels = 3;
  const PartedPairs<Level> gathered(places.pairs);
  for (unsigned i = 0; i < places.parted.size(); ++i) {
    const PartedTexels& texels = places.parted[i];
    std::byte* const upper = places.parted_pairs.data() + gathered.place(i);
    for (std::size_t corner = 0; corner < texels.size(); ++corner) {
      std::byte* const pair =
          upper + corner / 4 * gathered.down() + corner / 2 % 2 * gathered.kPair;
      std::memcpy(pair + corner % 2 * kTexelLevels * sizeof(Level), texels[corner],
                  (kTexelLevels + 1) * sizeof(Level));
    }
  }
}

template <typename Level>
void TileSampler<Level>::place_straight(const TilePlan& plan, const RowPath& path,
                                        std::span<const BrickRun> runs, RowPlaces& places) const {
  constexpr std::size_t kBlock = TexelBlocks::kBlockLevels * sizeof(Level);
  const TexelBlocks& blocks = plan.blocks();
  for (const BrickRun& run : runs) {
    const auto& [x_bricks, y_bricks, z_bricks] = run.bricks;
    const TexelPair y = texel_pair(path.axes[1], y_bricks, run.first);
    const TexelPair z = texel_pair(path.axes[2], z_bricks, run.first);
    const auto row = [&, along_x = x_bricks.near](int y_brick, int y_texel, int z_brick,
                                                  int z_texel) {
      return bricks_[static_cast<std::size_t>(path.slot(along_x, y_brick, z_brick))] +
             (blocks.along_y(y_texel) + blocks.along_z(z_texel));
    };
    StraightRun straight;
    straight.upper = {row(y_bricks.near, y.near, z_bricks.near, z.near),
                      row(y_bricks.far, y.far, z_bricks.near, z.near)};
    straight.lower = {row(y_bricks.near, y.near, z_bricks.far, z.far),
                      row(y_bricks.far, y.far, z_bricks.far, z.far)};
    straight.first = static_cast<std::size_t>(texel_pair(path.axes[0], x_bricks, run.first).near);
    straight.count = static_cast<std::size_t>(run.last - run.first);
    const std::size_t last = straight.first + straight.count - 1;
    for (std::size_t block = straight.first / TexelBlocks::kSide;
         block <= last / TexelBlocks::kSide; ++block) {
      for (const std::array<const std::byte*, 2>& rows : {straight.upper, straight.lower}) {
        __builtin_prefetch(rows[0] + block * kBlock);
        __builtin_prefetch(rows[1] + block * kBlock);
      }
    }
    places.straight.push_back(straight);
    places.straight_parts = {PixelPlaces<Level>::part(y.part), PixelPlaces<Level>::part(z.part)};
  }
}

/// The texels of each pixel's support, x fastest, then y, then z.
template <typename Level>
template <int width>
void TileSampler<Level>::place_supports(const TilePlan& plan, const PictureRow& row,
                                        RowPlaces& places) const {
  constexpr std::size_t kTexels = std::size_t{width} * width * width;
  places.texels.resize(inside_count(row) * kTexels);
  const std::byte** out = places.texels.data();
  for (int column = row.inside.first; column < row.inside.last; ++column) {
    const PixelSupport at = plan.support_at(row, column);
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
void TileSampler<Level>::sample_row(const TilePlan& plan, const PictureRow& row, RowPlaces& places,
                                    Level* rgb) {
  if (!places.straight.empty()) {
    for (const StraightRun& run : places.straight) {
      mix_straight(run, places.straight_parts, rgb);
      rgb += 3 * run.count;
    }
    return;
  }
  switch (kind_) {
    case Interpolation::nearest:
      take_nearest(places);
      break;
    case Interpolation::linear:
      gather_parted(places);
      mix_linear(places.pairs, inside_count(row), row_.data());
      break;
    case Interpolation::cubic:
      mix_supports(plan, row, places);
      break;
  }
  pack_pixels(row_.data(), inside_count(row), rgb);
}

template <typename Level>
void TileSampler<Level>::take_nearest(const RowPlaces& places) {
  for (std::size_t i = 0; i < places.texels.size(); ++i) {
    std::memcpy(row_.data() + kPixelLevels * i, places.texels[i], 3 * sizeof(Level));
  }
}

template <typename Level>
void TileSampler<Level>::mix_supports(const TilePlan& plan, const PictureRow& row,
                                      const RowPlaces& places) {
  constexpr std::size_t kTexels = 64;
  std::array<Level, kTexels * kPixelLevels> support{};
  const std::byte* const* texel = places.texels.data();
  for (std::size_t i = 0; i < inside_count(row); ++i) {
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
