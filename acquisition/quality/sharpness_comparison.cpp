#include "acquisition/quality/sharpness_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "acquisition/quality/median.hpp"
#include "acquisition/quality/tile_comparison.hpp"
#include "acquisition/quality/weighted_median.hpp"

namespace biotomy::acquisition {
namespace {

/// Which the estimates have in common with all tiles: what the scatter between them cannot show.
constexpr double kCommonError = 0.005;

constexpr std::size_t kLeastTiles = 4;

/// For the sharpness of a frame alone.
constexpr double kLeastSignal = 1.0;
constexpr double kMostWeight = 20.0;

/// Of the weighted median: as of a median of normally scattering values, with as many of them as
/// the weights are worth.
double standard_error(const std::vector<Weighted>& values, double middle) {
  constexpr double kSigmaOfDeviation = 1.4826;  // of the median absolute deviation
  std::vector<double> deviations;
  double sum = 0.0;
  double squares = 0.0;
  for (const Weighted& value : values) {
    deviations.push_back(std::fabs(value.value - middle));
    sum += value.weight;
    squares += value.weight * value.weight;
  }
  return kMedianOfMean * kSigmaOfDeviation * median(std::move(deviations)) * std::sqrt(squares) /
         sum;
}

/// Of all tiles that can be compared, for one pair.
struct TileChanges {
  std::vector<Weighted> both;
  std::vector<Weighted> x;
  std::vector<Weighted> y;
  std::vector<Weighted> x_over_y;

  /// How many lie below a limit, which is no logarithm.
  int below(double limit) const {
    return static_cast<int>(std::count_if(both.begin(), both.end(), [&](const Weighted& tile) {
      return std::exp(tile.value) < limit;
    }));
  }
};

TileChanges changes_of(const FrameMeasures& frame, References references, const BandPair& pair) {
  TileChanges changes;
  for (std::size_t i = 0; i < frame.tiles.size(); ++i) {
    const TileMeasures& tile = frame.tiles[i];
    const double alike = likeness_of_detail(tile, references, i);
    const double certain =
        certainty(references, i, pair, frame.grid.tile(static_cast<int>(i)).area());
    if (alike < kLeastLikeness || certain <= 0.0) continue;
    const auto all = change_of_quotient(tile, references, i, pair, &both_axes);
    const auto x = change_of_quotient(tile, references, i, pair, &along_x);
    const auto y = change_of_quotient(tile, references, i, pair, &along_y);
    if (!all || !x || !y) continue;
    const double weight = alike * certain;
    changes.both.push_back({*all, weight});
    changes.x.push_back({*x, weight});
    changes.y.push_back({*y, weight});
    changes.x_over_y.push_back({*x - *y, weight});
  }
  return changes;
}

/// The mean of the pairs' medians, each over its effect, by the inverse of their variances.
class Combination {
 public:
  void add(const std::vector<Weighted>& changes, const BandPair& pair) {
    const double middle = weighted_median(changes);
    const double error = std::hypot(standard_error(changes, middle),
                                    kCommonError * pair.scatter / kBandPairs[0].scatter);
    const double weight = pair.effect * pair.effect / (error * error);
    sum_ += weight * middle / pair.effect;
    weights_ += weight;
  }

  SharpnessComparison::Estimate result() const {
    return {std::exp(sum_ / weights_), 1.0 / std::sqrt(weights_)};
  }

 private:
  double sum_ = 0.0;
  double weights_ = 0.0;
};

}  // namespace

double sharpness(const TileMeasures& tile) {
  return quotient(tile, kBandPairs[0], &both_axes);
}

double sharpness(const FrameMeasures& frame) {
  std::vector<Weighted> tiles;
  for (const TileMeasures& tile : frame.tiles) {
    const double signal = tile.signal_to_noise();
    if (signal > kLeastSignal) tiles.push_back({sharpness(tile), std::min(signal, kMostWeight)});
  }
  return tiles.empty() ? 0.0 : weighted_median(std::move(tiles));
}

std::optional<SharpnessComparison> compare_sharpness(const FrameMeasures& frame,
                                                     References references, double limit) {
  if (!comparable(frame, references)) return std::nullopt;
  Combination ratio;
  Combination x;
  Combination y;
  Combination x_over_y;
  SharpnessComparison comparison;
  for (const BandPair& pair : kBandPairs) {
    const TileChanges changes = changes_of(frame, references, pair);
    if (changes.both.size() < kLeastTiles) continue;
    ratio.add(changes.both, pair);
    x.add(changes.x, pair);
    y.add(changes.y, pair);
    x_over_y.add(changes.x_over_y, pair);
    comparison.tiles = std::max(comparison.tiles, static_cast<int>(changes.both.size()));
    comparison.below = std::max(comparison.below, changes.below(std::pow(limit, pair.effect)));
  }
  if (comparison.tiles == 0) return std::nullopt;
  comparison.ratio = ratio.result();
  comparison.along_x = x.result();
  comparison.along_y = y.result();
  comparison.anisotropy = x_over_y.result();
  comparison.anisotropy.value =
      std::min(comparison.anisotropy.value, 1.0 / comparison.anisotropy.value);
  return comparison;
}

std::optional<double> compare_contrast(const FrameMeasures& frame, References references) {
  if (!comparable(frame, references)) return std::nullopt;
  std::vector<Weighted> changes;
  for (std::size_t i = 0; i < frame.tiles.size(); ++i) {
    const TileMeasures& tile = frame.tiles[i];
    const double alike = likeness_of_colours(tile, references, i);
    const int pixels = frame.grid.tile(static_cast<int>(i)).area();
    const double certain = certainty(references, i, kBandPairs[1], pixels);
    if (alike < kLeastLikeness || certain <= 0.0) continue;
    changes.push_back({change_of_energy(tile, references, i, DetailBand::fine), alike * certain});
  }
  if (changes.size() < kLeastTiles) return std::nullopt;
  // Of energies, and contrast is an amplitude.
  return std::exp(0.5 * weighted_median(std::move(changes)));
}

}  // namespace biotomy::acquisition
