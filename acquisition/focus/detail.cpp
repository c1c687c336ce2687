#include "acquisition/focus/detail.hpp"

#include <algorithm>
#include <cmath>

namespace biotomy::acquisition {
namespace {

double mean_brightness(const FrameMeasures& measures) {
  double sum = 0.0;
  double pixels = 0.0;
  for (int number = 0; number < measures.grid.count(); ++number) {
    const TileMeasures& tile = measures.tiles[static_cast<std::size_t>(number)];
    const double counted = (1.0 - tile.clipped) * measures.grid.tile(number).area();
    sum += counted * tile.brightness();
    pixels += counted;
  }
  return pixels > 0.0 ? sum / pixels : 0.0;
}

/// The variance by noise of a level's energy that is the mean over `pixels`, of which noise adds
/// `noise` along each axis. The squares of neighbouring gradients hang together, which makes the
/// mean's variance three times that of independent ones, and what is taken out for noise carries an
/// error of its own, about as large. The wave and the noise beat: twice 4 · energy · noise.
double variance_of(double energy, double noise, double pixels) {
  constexpr double kNoiseAlone = 48.4;
  constexpr double kBeat = 8.0;
  return (kNoiseAlone * noise * noise + kBeat * std::max(energy, 0.0) * noise) / pixels;
}

Detail detail_of(const TileMeasures& tile, double pixels, double scale) {
  const double fine = tile.detail(DetailBand::fine).sum();
  const double middle = tile.detail(DetailBand::middle).sum();
  const double variance = variance_of(fine, tile.noise[DetailBand::fine], pixels) +
                          variance_of(middle, tile.noise[DetailBand::middle], 0.25 * pixels);
  return {scale * (fine + middle), scale * std::sqrt(variance)};
}

}  // namespace

std::vector<Detail> detail_of_tiles(const FrameMeasures& measures) {
  std::vector<Detail> tiles(measures.tiles.size());
  const double brightness = mean_brightness(measures);
  if (brightness <= 0.0) return tiles;
  for (int number = 0; number < measures.grid.count(); ++number) {
    const auto index = static_cast<std::size_t>(number);
    const TileMeasures& tile = measures.tiles[index];
    const double pixels = (1.0 - tile.clipped) * measures.grid.tile(number).area();
    if (pixels < 1.0) continue;
    tiles[index] = detail_of(tile, pixels, 1.0 / (brightness * brightness));
  }
  return tiles;
}

std::vector<std::size_t> telling_tiles(std::span<const std::vector<Detail>> frames) {
  constexpr double kLeastDetail = 5.0;  // standard deviations, where the tile is sharpest
  std::vector<std::size_t> numbers;
  for (std::size_t number = 0; number < frames.front().size(); ++number) {
    const auto shows_detail = [&](const std::vector<Detail>& tiles) {
      return tiles[number].energy > kLeastDetail * tiles[number].error;
    };
    if (std::ranges::any_of(frames, shows_detail)) numbers.push_back(number);
  }
  return numbers;
}

Detail sum(const std::vector<Detail>& tiles, std::span<const std::size_t> numbers) {
  Detail total;
  double variance = 0.0;
  for (const std::size_t number : numbers) {
    total.energy += tiles[number].energy;
    variance += tiles[number].error * tiles[number].error;
  }
  total.error = std::sqrt(variance);
  return total;
}

}  // namespace biotomy::acquisition
