#include "reconstruct/section/tile_sampler.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace biotomy::reconstruct {
namespace {

constexpr std::size_t kColours = TexelBlocks::kColours;
constexpr std::size_t kSupportLevels = 4;  // of a texel for cubic: one means nothing

std::size_t inside_count(const PictureRow& row) {
  return static_cast<std::size_t>(row.inside.last - row.inside.first);
}

}  // namespace

template <typename Level>
TileSampler<Level>::TileSampler(Interpolation kind, const std::array<Level, 3>& background)
    : kind_(kind) {
  for (int i = 0; i < kMostPixels; ++i) {
    background_.insert(background_.end(), background.begin(), background.end());
  }
}

// While a row is sampled the next one's memory is on its way.
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
  const ColumnRange& widest = plan.tile().columns;
  for (RowPlaces& places : places_) {
    places.linear.resize(static_cast<std::size_t>(widest.last - widest.first));
  }
  const std::vector<PictureRow>& rows = plan.rows();
  for (std::size_t i = 0; i <= rows.size(); ++i) {
    PairLines<Level> ahead;
    if (i < rows.size()) {
      place_row(plan, i, places_[i % 2]);
      ahead = lines_ahead(rows[i], places_[i % 2]);
    }
    if (i == 0 || inside_count(rows[i - 1]) == 0) {
      ahead.ask(0, ahead.count());
    }
    if (i == 0) {
      continue;
    }
    const PictureRow& row = rows[i - 1];
    auto* out = picture.ptr<Level>(row.row - first_row);
    paint(out + 3 * std::ptrdiff_t{row.columns.first}, row.inside.first - row.columns.first);
    if (inside_count(row) > 0) {
      sample_row(plan, row, places_[(i - 1) % 2], ahead,
                 out + 3 * std::ptrdiff_t{row.inside.first});
    }
    paint(out + 3 * std::ptrdiff_t{row.inside.last}, row.columns.last - row.inside.last);
  }
}

template <typename Level>
void TileSampler<Level>::paint(Level* rgb, int count) const {
  std::copy_n(background_.begin(), 3 * count, rgb);
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
      place_linear(plan, number, places);
      break;
    case Interpolation::cubic:
      place_supports<4>(plan, row, places);
      break;
  }
}

template <typename Level>
void TileSampler<Level>::place_linear(const TilePlan& plan, std::size_t number,
                                      RowPlaces& places) const {
  const RowPath& path = plan.path(number);
  const PictureRow& row = plan.rows()[number];
  const std::size_t count = inside_count(row);
  places.straight.clear();
  if (row.is_straight() && path.axes[0].is_inside(static_cast<int>(count))) {
    place_straight(plan, path, count, places);
    return;
  }
  reconstruct::place_row(path, static_cast<int>(count), bricks_.data(), places.linear);
  for (std::size_t i = 0; i < places.linear.parted_count; ++i) {
    const PartedPixel& parted = places.linear.parted[i];
    for (std::size_t j = 0; j < 2; ++j) {
      __builtin_prefetch(parted.upper[j]);
      __builtin_prefetch(parted.lower[j]);
    }
  }
}

template <typename Level>
void TileSampler<Level>::place_straight(const TilePlan& plan, const RowPath& path,
                                        std::size_t count, RowPlaces& places) const {
  constexpr std::size_t kBlock = TexelBlocks::kBlockLevels * sizeof(Level);
  const TexelBlocks& blocks = plan.blocks();
  const AxisPlace y(path.axes[1], 0);
  const AxisPlace z(path.axes[2], 0);
  places.straight_parts = {PixelPlaces<Level>::part(y.part), PixelPlaces<Level>::part(z.part)};
  for (std::size_t pixel = 0; pixel < count;) {
    const AxisPlace x(path.axes[0], static_cast<int>(pixel));
    const auto row = [&](int y_brick, int y_texel, int z_brick, int z_texel) {
      return bricks_[static_cast<std::size_t>(path.slot(x.near_brick, y_brick, z_brick))] +
             (blocks.along_y(y_texel) + blocks.along_z(z_texel));
    };
    StraightRun straight;
    straight.upper = {row(y.near_brick, y.near, z.near_brick, z.near),
                      row(y.far_brick, y.far, z.near_brick, z.near)};
    straight.lower = {row(y.near_brick, y.near, z.far_brick, z.far),
                      row(y.far_brick, y.far, z.far_brick, z.far)};
    straight.first = static_cast<std::size_t>(x.near);
    straight.count = std::min(count - pixel, static_cast<std::size_t>(path.axes[0].side - x.near));
    const std::size_t last = straight.first + straight.count - 1;
    for (std::size_t block = straight.first / TexelBlocks::kSide;
         block <= last / TexelBlocks::kSide; ++block) {
      for (const std::array<const std::byte*, 2>& rows : {straight.upper, straight.lower}) {
        __builtin_prefetch(rows[0] + block * kBlock);
        __builtin_prefetch(rows[1] + block * kBlock);
      }
    }
    pixel += straight.count;
    places.straight.push_back(straight);
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
        support[axis][static_cast<std::size_t>(j)] =
            plan.places()[axis].of(std::min(voxel, row.border[axis]));
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
PairLines<Level> TileSampler<Level>::lines_ahead(const PictureRow& row,
                                                 const RowPlaces& places) const {
  const bool in_pairs = kind_ == Interpolation::linear && places.straight.empty();
  return in_pairs ? PairLines<Level>(places.linear, inside_count(row)) : PairLines<Level>();
}

template <typename Level>
void TileSampler<Level>::sample_row(const TilePlan& plan, const PictureRow& row, RowPlaces& places,
                                    const PairLines<Level>& ahead, Level* rgb) {
  if (!places.straight.empty()) {
    for (const StraightRun& run : places.straight) {
      mix_straight(run, places.straight_parts, rgb);
      rgb += kColours * run.count;
    }
    return;
  }
  switch (kind_) {
    case Interpolation::nearest:
      take_nearest(places, rgb);
      break;
    case Interpolation::linear:
      mix_pairs(places.linear, inside_count(row), ahead, rgb);
      break;
    case Interpolation::cubic:
      mix_supports(plan, row, places, rgb);
      break;
  }
}

template <typename Level>
void TileSampler<Level>::mix_pairs(PixelPlaces<Level>& places, std::size_t count,
                                   const PairLines<Level>& ahead, Level* rgb) {
  parted_pairs_.join(places);
  mix_linear(places, count, ahead, rgb);
  ahead.ask((count + kRoomPixels - 1) / kRoomPixels * kRoomPixels, ahead.count());
}

template <typename Level>
void TileSampler<Level>::take_nearest(const RowPlaces& places, Level* rgb) {
  for (const std::byte* texel : places.texels) {
    std::memcpy(rgb, texel, kColours * sizeof(Level));
    rgb += kColours;
  }
}

template <typename Level>
void TileSampler<Level>::mix_supports(const TilePlan& plan, const PictureRow& row,
                                      const RowPlaces& places, Level* rgb) const {
  constexpr std::size_t kTexels = 64;
  std::array<Level, kTexels * kSupportLevels> support{};
  const std::byte* const* texel = places.texels.data();
  for (std::size_t i = 0; i < inside_count(row); ++i) {
    for (std::size_t j = 0; j < kTexels; ++j) {
      std::memcpy(support.data() + kSupportLevels * j, *texel++, kColours * sizeof(Level));
    }
    std::array<float, 3> part = plan.support_at(row, row.inside.first + static_cast<int>(i)).part;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      part[axis] = row.on_centres[axis] ? 0.0F : part[axis];
    }
    std::array<Level, kSupportLevels> pixel{};
    mix_cubic(support.data(), part, pixel.data());
    std::copy_n(pixel.begin(), kColours, rgb + kColours * i);
  }
}

template class TileSampler<std::uint8_t>;
template class TileSampler<std::uint16_t>;

}  // namespace biotomy::reconstruct
