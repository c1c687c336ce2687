#pragma once

#include <array>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "acquisition/quality/clipping_levels.hpp"
#include "acquisition/quality/tile_grid.hpp"

namespace biotomy::acquisition {

/// The mean square of a derivative of the brightness, along both axes, with what noise adds taken
/// out; it may be a little below zero where there is no detail. In (full scale per pixel)², a pixel
/// of the level it was measured at.
struct DetailEnergy {
  double along_x = 0.0;
  double along_y = 0.0;

  double sum() const { return along_x + along_y; }
};

/// What one look at a tile tells. Pixels in which a colour is clipped (see ClippingLevels) are left
/// out, and with them every derivative that reaches one: a saturated spot would turn the order of
/// sharp and blurred about.
struct TileMeasures {
  std::array<double, 3> mean{};  ///< R, G, B, of full scale
  double clipped = 0.0;          ///< part of its pixels
  double noise = 0.0;            ///< standard deviation of the brightness, of full scale
  DetailEnergy curvature;        ///< the second derivative of the picture
  DetailEnergy fine;             ///< the gradient of the picture: strongest at 1/4 cycle per pixel
  DetailEnergy middle;           ///< of the picture at half its resolution: at 1/8
  DetailEnergy coarse;           ///< at a quarter: at 1/16

  double brightness() const { return 0.25 * mean[0] + 0.5 * mean[1] + 0.25 * mean[2]; }

  /// How much more energy its gradient has than the noise would give it.
  double signal_to_noise() const;
};

struct FrameMeasures {
  TileGrid grid;
  std::vector<TileMeasures> tiles;  ///< as the grid numbers them
  ClippingLevels clipping{};        ///< of the frame: what they left out
};

/// Measures all tiles in one pass. `image` is CV_8UC3 or CV_16UC3, R G B. The time depends on the
/// size alone.
///
/// Second derivatives are the differences 1, -2, 1. Gradients are Sobel's (3 × 3, an eighth of the
/// sum), whose response to a wave along the axis is sin(2πf): greatest at half the Nyquist
/// frequency. Levels are means of 2 × 2 pixels. The noise is estimated after Immerkær, "Fast noise
/// variance estimation", Computer Vision and Image Understanding 64 (1996) 300-302, with the mean
/// of squares in place of the mean of amounts; white noise of variance σ² adds 6σ² to each axis'
/// curvature, 3σ²/16 to its gradient, and to the gradients of the levels a quarter and a sixteenth
/// of that.
FrameMeasures measure_frame(const cv::Mat& image);

}  // namespace biotomy::acquisition
