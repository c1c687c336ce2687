#pragma once

#include <array>
#include <memory>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "acquisition/quality/brightness_plane.hpp"
#include "acquisition/quality/clipping_levels.hpp"
#include "acquisition/quality/detail_energy.hpp"
#include "acquisition/quality/tile_grid.hpp"

namespace biotomy::acquisition {

/// What one look at a tile tells. Pixels in which a colour is clipped (see ClippingLevels) are left
/// out, and with them every derivative that reaches one: a saturated spot would turn the order of
/// sharp and blurred about.
struct TileMeasures {
  std::array<double, 3> mean{};  ///< R, G, B, of full scale
  double clipped = 0.0;          ///< part of its pixels
  PerBand<DetailEnergy> energy;  ///< as measured, with the noise in it
  PerBand<double> noise;         ///< of it, along each axis
  double white_variance = 0.0;   ///< of the noise, as the tile alone tells it

  DetailEnergy detail(DetailBand band) const {
    return {energy[band].along_x - noise[band], energy[band].along_y - noise[band]};
  }

  double brightness() const { return 0.25 * mean[0] + 0.5 * mean[1] + 0.25 * mean[2]; }

  /// How much more energy its gradient has than the noise would give it.
  double signal_to_noise() const;
};

/// The middle of every tile, at most 112 pixels wide and high, with what derivatives reach beyond.
using TileMiddles = std::vector<BrightnessPlane>;

struct FrameMeasures {
  TileGrid grid;
  std::vector<TileMeasures> tiles;  ///< as the grid numbers them
  ClippingLevels clipping{};        ///< of the frame: what they left out
  /// By which the frame can be compared with another of the same face (see CameraNoise).
  std::shared_ptr<const TileMiddles> middles{};
};

/// Measures all tiles in one pass. `image` is CV_8UC3 or CV_16UC3, R G B. The time depends on the
/// size alone. The noise is told from the frame alone, as if it were white (see DetailMeasurer): so
/// it is in a frame of a monochrome sensor, of three of them, or of a colour sensor whose frame was
/// made smaller. Of other cameras a CameraNoise knows more.
FrameMeasures measure_frame(const cv::Mat& image);

}  // namespace biotomy::acquisition
