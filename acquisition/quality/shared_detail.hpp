#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "acquisition/quality/tile_grid.hpp"

namespace biotomy::acquisition {

/// The fine detail of a tile, told from noise without knowing the noise.
///
/// Of each 2 × 2 pixels the two diagonals are two images of one scene whose noise has nothing in
/// common (see FacePrint). Second differences along either axis are taken of both images and
/// multiplied: the mean of the product is the detail's alone, however strong the noise is. The
/// mean of their squares has both in it.
struct SharedDetail {
  double shared = 0.0;  ///< sum of the products, (full scale)²
  double own = 0.0;     ///< sum of the halved sums of squares, likewise
  double count = 0.0;   ///< of pixels of the scale

  /// What the two images do not share: noise, and detail that is too fine for either.
  double unshared() const { return own - shared; }
};

/// The scales at which it is measured: the picture at a half, a quarter and an eighth of its
/// resolution. A second difference answers most to waves of two pixels of its scale.
inline constexpr std::size_t kDetailScales = 3;

struct TileDetail {
  double brightness = 0.0;  ///< mean over the pixels looked at, of full scale
  std::array<SharedDetail, kDetailScales> scales;
};

/// Of all tiles of an image, CV_8UC3 or CV_16UC3, R G B. Looked at is what is not 0 in `usable`
/// (CV_8UC1 at half the resolution) and is not clipped.
std::vector<TileDetail> measure_shared_detail(const cv::Mat& image, const TileGrid& grid,
                                              const cv::Mat& usable);

}  // namespace biotomy::acquisition
