#pragma once

#include <memory>
#include <optional>
#include <span>

#include "acquisition/quality/frame_measures.hpp"

namespace biotomy::acquisition {

/// How sharp a tile is: the mean square of the second derivative over that of the gradient, which
/// is the mean of (2πf)² over the gradient's spectrum. Contrast, lamp and exposure cancel, and so
/// does most of what the tile contains; blur takes the high frequencies first. (Of a wave of one
/// frequency it would take nothing: tissue is none.) 0 without detail.
///
/// The nearest relative is the ratio of high to low frequency energy of Brenner-type focus measures
/// (e.g. Subbarao, Choi and Nikzad, "Focusing techniques", Optical Engineering 32 (1993)
/// 2824-2836); the difference is that both energies are freed from noise.
double sharpness(const TileMeasures& tile);
double sharpness_along_x(const TileMeasures& tile);
double sharpness_along_y(const TileMeasures& tile);

/// Of a frame: the median over its tiles, each weighted by its signal. 0 without detail. For frames
/// of one scene only: otherwise compare tile by tile.
double sharpness(const FrameMeasures& frame);

/// A frame's sharpness as parts of what it is compared with.
struct SharpnessComparison {
  /// With its relative standard error, from how the tiles scatter.
  struct Estimate {
    double value = 1.0;
    double error = 0.0;
  };

  Estimate ratio;
  Estimate anisotropy;  ///< of the less sharp axis over the sharper: below 1 when smeared along one
  int tiles = 0;        ///< that could be compared
  int below = 0;        ///< of them below the limit asked for
};

/// Compares tile by tile with the median of the references, frames of the same size: this layer's
/// sharpest, or the last layers'. Both are medians over the tiles, each weighted by its
/// signal-to-noise ratio up to 20; a tile counts when its gradients carry more signal than noise.
/// Nothing when fewer than four tiles can be compared. `limit` only counts.
///
/// A blur that takes 15 % of the contrast at half the Nyquist frequency leaves 0.84 to 0.90 on the
/// twin's tissue; faces that follow one another differ by 0.015 (standard deviation, 0.5
/// megapixel).
std::optional<SharpnessComparison> compare_sharpness(
    const FrameMeasures& frame, std::span<const std::shared_ptr<const FrameMeasures>> references,
    double limit);

}  // namespace biotomy::acquisition
