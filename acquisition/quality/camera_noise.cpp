#include "acquisition/quality/camera_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <opencv2/core/utility.hpp>

#include "acquisition/quality/face_print.hpp"

namespace biotomy::acquisition {
namespace {

/// Of all tiles together: with less, the noise's own fluctuation is too much of it.
constexpr int kLeastPixels = 20000;

/// White noise adds to the gradient and to the curvature in one proportion. It is no longer white
/// when this is larger, or smaller, by such a factor.
constexpr double kColoured = 1.5;

/// What two frames tell of a tile.
struct TilePair {
  double brightness = 0.0;
  PerBand<double> energy;  ///< of either frame, along each axis
  PerBand<double> noise;   ///< likewise
  std::optional<double> face_energy;
  std::optional<double> face_noise;
};

/// Of two planes of the same place, over √2: as much noise as one of them has, and nothing else.
void difference(const BrightnessPlane& one, const BrightnessPlane& other, BrightnessPlane& out) {
  out.resize(one.width, one.height);
  constexpr float kScale = 1.0F / std::numbers::sqrt2_v<float>;
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    out.values[i] = kScale * (one.values[i] - other.values[i]);
  }
}

/// All of a middle but its margin.
cv::Rect core_of(const BrightnessPlane& middle) {
  constexpr int kReach = DetailMeasurer::kReach;
  return {kReach, kReach, std::max(middle.width - 2 * kReach, 0),
          std::max(middle.height - 2 * kReach, 0)};
}

class PairMeasurer {
 public:
  TilePair measure(const BrightnessPlane& one, const BrightnessPlane& other) {
    difference(one, other, difference_);
    const cv::Rect core = core_of(one);
    const PerBand<DetailEnergy> noise = detail_.measure(difference_, core).energy;
    const PerBand<DetailEnergy> first = detail_.measure(one, core).energy;
    const PerBand<DetailEnergy> second = detail_.measure(other, core).energy;
    TilePair pair;
    for (std::size_t band = 0; band < kDetailBands; ++band) {
      pair.noise.values[band] = 0.5 * noise.values[band].sum();
      pair.energy.values[band] = 0.25 * (first.values[band].sum() + second.values[band].sum());
    }
    pair.face_noise = print_energy(difference_);
    const auto first_face = print_energy(one);
    const auto second_face = print_energy(other);
    if (first_face && second_face) pair.face_energy = 0.5 * (*first_face + *second_face);
    return pair;
  }

 private:
  BrightnessPlane difference_;
  DetailMeasurer detail_;
};

/// A line through noise over brightness, of which neither part is below zero. Tiles count by the
/// inverse square of their energy.
class NoiseLine {
 public:
  void add(double brightness, double energy, double noise) {
    if (energy <= 0.0) return;
    const double weight = 1.0 / (energy * energy);
    weights_ += weight;
    light_ += weight * brightness;
    light_squared_ += weight * brightness * brightness;
    noise_ += weight * noise;
    noise_by_light_ += weight * noise * brightness;
  }

  std::optional<BandNoise> fit() const {
    if (light_squared_ <= 0.0) return std::nullopt;
    // Of the square of the brightness; with less all tiles are as bright.
    constexpr double kLeastSpread = 1e-6;
    const BandNoise light_alone{.dark = 0.0, .light = noise_by_light_ / light_squared_};
    const double spread = weights_ * light_squared_ - light_ * light_;
    if (spread < kLeastSpread * weights_ * light_squared_) return light_alone;
    const double light = (weights_ * noise_by_light_ - light_ * noise_) / spread;
    const double dark = (noise_ - light * light_) / weights_;
    if (light < 0.0) return BandNoise{.dark = noise_ / weights_, .light = 0.0};
    return dark < 0.0 ? light_alone : BandNoise{.dark = dark, .light = light};
  }

 private:
  double weights_ = 0.0;
  double light_ = 0.0;
  double light_squared_ = 0.0;
  double noise_ = 0.0;
  double noise_by_light_ = 0.0;
};

BandNoise noise_of_band(const std::vector<TilePair>& tiles, DetailBand band) {
  NoiseLine line;
  for (const TilePair& tile : tiles) line.add(tile.brightness, tile.energy[band], tile.noise[band]);
  return line.fit().value_or(BandNoise{});
}

std::optional<BandNoise> noise_of_faces(const std::vector<TilePair>& tiles) {
  NoiseLine line;
  for (const TilePair& tile : tiles) {
    if (tile.face_energy && tile.face_noise) {
      line.add(tile.brightness, *tile.face_energy, *tile.face_noise);
    }
  }
  return line.fit();
}

}  // namespace

bool is_white(const CameraNoise& noise) {
  constexpr double kBrightness = 0.5;
  const auto strength = [&](DetailBand band) {
    return noise.bands[band].at(kBrightness) / kWhiteNoise[band];
  };
  const double fine = strength(DetailBand::fine);
  const double finest = strength(DetailBand::curvature);
  return fine <= kColoured * finest && finest <= kColoured * fine;
}

std::optional<CameraNoise> noise_between(const FrameMeasures& one, const FrameMeasures& other) {
  if (one.grid != other.grid || !one.middles || !other.middles) return std::nullopt;
  int pixels = 0;
  for (const BrightnessPlane& middle : *one.middles) pixels += core_of(middle).area();
  if (pixels < kLeastPixels) return std::nullopt;
  std::vector<TilePair> tiles(one.tiles.size());
  cv::parallel_for_({0, static_cast<int>(tiles.size())}, [&](const cv::Range& numbers) {
    PairMeasurer measurer;
    for (int number = numbers.start; number < numbers.end; ++number) {
      const auto i = static_cast<std::size_t>(number);
      tiles[i] = measurer.measure((*one.middles)[i], (*other.middles)[i]);
      tiles[i].brightness = 0.5 * (one.tiles[i].brightness() + other.tiles[i].brightness());
    }
  });
  CameraNoise noise;
  for (std::size_t band = 0; band < kDetailBands; ++band) {
    noise.bands.values[band] = noise_of_band(tiles, static_cast<DetailBand>(band));
  }
  noise.face = noise_of_faces(tiles);
  return noise;
}

FrameMeasures with_noise(const FrameMeasures& measures, const CameraNoise& noise) {
  FrameMeasures changed = measures;
  if (is_white(noise)) {
    for (TileMeasures& tile : changed.tiles) tile.noise = white_noise(tile.white_variance);
    return changed;
  }
  for (TileMeasures& tile : changed.tiles) {
    for (std::size_t band = 0; band < kDetailBands; ++band) {
      tile.noise.values[band] = noise.bands.values[band].at(tile.brightness());
    }
  }
  return changed;
}

}  // namespace biotomy::acquisition
