#pragma once

#include <cmath>
#include <memory>
#include <random>

#include <opencv2/core/types.hpp>

#include "acquisition/quality/frame_measures.hpp"

namespace biotomy::tests {

/// The measures that a camera would find of a face, without pictures: each tile's detail falls as
/// a lens blurs it, by a parabola of its logarithm.
struct FakeFace {
  double sharp_at_um = 5000.0;  ///< in the middle of the frame
  double across_um = 0.0;       ///< so much farther at the right edge
  double down_um = 0.0;
  double width_um = 150.0;  ///< where a tile has lost exp(−1/2) of its energy
  double detail = 0.01;     ///< energy where it is sharp; per full scale squared
  double noise = 0.0;       ///< of a pixel's brightness, of full scale
  int covered_tiles = 0;    ///< so many tiles show something that never changes
  std::mt19937_64 random{1};
  std::normal_distribution<double> normal{};

  std::shared_ptr<const acquisition::FrameMeasures> at(double position_um) {
    auto measures = std::make_shared<acquisition::FrameMeasures>();
    measures->grid = acquisition::TileGrid::of(cv::Size(1200, 800));
    for (int number = 0; number < measures->grid.count(); ++number) {
      const cv::Rect tile = measures->grid.tile(number);
      const double x = (tile.x + 0.5 * tile.width) / 1200.0 - 0.5;
      const double y = (tile.y + 0.5 * tile.height) / 800.0 - 0.5;
      const double sharp_um = sharp_at_um + across_um * x + down_um * y;
      const double away = (position_um - sharp_um) / width_um;
      const double left = number < covered_tiles ? 1.0 : std::exp(-0.5 * away * away);
      acquisition::TileMeasures seen;
      seen.mean = {0.5, 0.5, 0.5};
      seen.white_variance = noise * noise;
      seen.noise = acquisition::white_noise(seen.white_variance);
      for (std::size_t band = 0; band < acquisition::kDetailBands; ++band) {
        seen.energy.values[band] = {seen.noise.values[band], seen.noise.values[band]};
      }
      seen.energy[acquisition::DetailBand::fine].along_x +=
          detail * left + noise * noise / 80.0 * normal(random);
      measures->tiles.push_back(seen);
    }
    return measures;
  }
};

}  // namespace biotomy::tests
