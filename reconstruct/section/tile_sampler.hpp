#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/section/interpolation.hpp"
#include "reconstruct/section/texel_kernels.hpp"
#include "reconstruct/section/tile_plan.hpp"

namespace biotomy::reconstruct {

/// Fills tiles of a picture as they were planned. `Level` is std::uint8_t or std::uint16_t. Keeps
/// its working memory from tile to tile; for one thread.
template <typename Level>
class TileSampler {
 public:
  explicit TileSampler(Interpolation kind) : kind_(kind) {}

  /// `bricks` are those of plan.bricks(), in their order; null ones are fill value. Writes R G B of
  /// the tile's pixels to `picture` (CV_8UC3 or CV_16UC3), of which row 0 is row `first_row` of the
  /// grid.
  void fill(const TilePlan& plan, std::span<const std::byte* const> bricks,
            const std::array<Level, 3>& background, int first_row, cv::Mat& picture);

 private:
  /// Where a row's pixels lie: those of its runs, and each texel of its patches' supports.
  struct RowPlaces {
    PixelPlaces<Level> runs;
    std::vector<const std::byte*> texels;
  };

  void place_row(const TilePlan& plan, const PlannedRow& row, RowPlaces& places) const;
  void place_runs(const TilePlan& plan, const PlannedRow& row, PixelPlaces<Level>& places) const;
  template <int width>
  void place_patches(const TilePlan& plan, const PlannedRow& row,
                     std::vector<const std::byte*>& texels) const;
  void sample_row(const TilePlan& plan, const PlannedRow& row, const RowPlaces& places);
  void mix_patches(const TilePlan& plan, const PlannedRow& row,
                   const std::vector<const std::byte*>& texels);
  Level* pixel_of(const TilePlan& plan, const PlannedPatch& patch);
  const std::byte* brick(int place) const;

  Interpolation kind_;
  std::span<const std::byte* const> bricks_;
  std::vector<std::byte> fill_value_;
  std::array<RowPlaces, 2> places_;  // of a row, and of the next
  std::vector<Level> row_;           // pixels of the tile's columns
  PixelPlaces<Level> patch_places_;
  std::vector<std::byte> gathered_;  // supports of patches
  std::vector<Level> mixed_;         // pixels of the patches
};

}  // namespace biotomy::reconstruct
