#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/bricks/texel_kernels.hpp"
#include "reconstruct/section/interpolation.hpp"
#include "reconstruct/section/parted_pairs.hpp"
#include "reconstruct/section/tile_plan.hpp"

namespace biotomy::reconstruct {

/// Fills tiles of a picture as they were planned. `Level` is std::uint8_t or std::uint16_t. Keeps
/// its working memory from tile to tile; for one thread.
template <typename Level>
class TileSampler {
 public:
  /// `background` is the colour of pixels outside the cuboid.
  TileSampler(Interpolation kind, const std::array<Level, 3>& background);

  /// `bricks` are those of plan.bricks(), in their order; null ones are fill value. Writes R G B of
  /// the tile's pixels to `picture` (CV_8UC3 or CV_16UC3), of which row 0 is row `first_row` of the
  /// grid.
  void fill(const TilePlan& plan, std::span<const std::byte* const> bricks, int first_row,
            cv::Mat& picture);

 private:
  /// Where a row's pixels lie.
  struct RowPlaces {
    PixelPlaces<Level> linear;
    std::vector<StraightRun> straight;  // of all pixels instead, where that can be
    StraightParts<Level> straight_parts;
    std::vector<const std::byte*> texels;  // nearest, cubic: of the supports of all pixels
  };

  void paint(Level* rgb, int count) const;
  void place_row(const TilePlan& plan, std::size_t number, RowPlaces& places);
  void place_linear(const TilePlan& plan, std::size_t number, RowPlaces& places) const;
  void place_straight(const TilePlan& plan, const RowPath& path, std::size_t count,
                      RowPlaces& places) const;
  template <int width>
  void place_supports(const TilePlan& plan, const PictureRow& row, RowPlaces& places) const;
  PairLines<Level> lines_ahead(const PictureRow& row, const RowPlaces& places) const;
  void sample_row(const TilePlan& plan, const PictureRow& row, RowPlaces& places,
                  const PairLines<Level>& ahead, Level* rgb);
  static void take_nearest(const RowPlaces& places, Level* rgb);
  void mix_pairs(PixelPlaces<Level>& places, std::size_t count, const PairLines<Level>& ahead,
                 Level* rgb);
  void mix_supports(const TilePlan& plan, const PictureRow& row, const RowPlaces& places,
                    Level* rgb) const;

  Interpolation kind_;
  std::vector<Level> background_;         // pixels of it
  std::vector<const std::byte*> bricks_;  // by slot of the tile's box
  std::vector<std::byte> fill_value_;
  std::array<RowPlaces, 2> places_;  // of a row, and of the next
  PartedPairs<Level> parted_pairs_;
};

}  // namespace biotomy::reconstruct
