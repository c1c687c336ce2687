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
/// The nearest relatives are focus measures that divide high by low frequency energy (e.g.
/// Subbarao, Choi and Nikzad, "Focusing techniques", Optical Engineering 32 (1993) 2824-2836); the
/// difference is that both energies are freed from noise.
double sharpness(const TileMeasures& tile);

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
  Estimate along_x;
  Estimate along_y;
  Estimate anisotropy;  ///< of the less sharp axis over the sharper: below 1 when smeared along one
  int tiles = 0;        ///< that could be compared
  int below = 0;        ///< of them below the limit asked for
};

/// Compares tile by tile with the median of the references, frames of the same size: this layer's
/// sharpest, or the last layers'. Of each tile three quotients are compared: the curvature's energy
/// over the gradient's, the gradient's over that at half the resolution, and that over the one at a
/// quarter, which feel blur less and noise much less. Each gives a median over the tiles, weighted
/// by how sure a tile is and by how much its coarse detail resembles the references'; the three are
/// combined by their standard errors. Nothing when fewer than four tiles can be compared. `limit`
/// only counts.
///
/// A blur that takes 15 % of the contrast at half the Nyquist frequency leaves 0.87 on the twin's
/// tissue; see docs/quality.md for how it scatters.
std::optional<SharpnessComparison> compare_sharpness(
    const FrameMeasures& frame, std::span<const std::shared_ptr<const FrameMeasures>> references,
    double limit);

/// What is left of the contrast of fine detail, relative to the references: the median over the
/// tiles whose mean colour is the same, which no blur changes. Nothing with fewer than four of
/// them. It feels the content more than quotients do; but those compare what is left of the detail,
/// and after much blur that is what is left of the noise.
std::optional<double> compare_contrast(
    const FrameMeasures& frame, std::span<const std::shared_ptr<const FrameMeasures>> references);

}  // namespace biotomy::acquisition
