#include "acquisition/quality/sharpness_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "acquisition/quality/median.hpp"

namespace biotomy::acquisition {
namespace {

/// Two neighbouring bands of a tile's detail. Blur takes more of the finer.
struct BandPair {
  DetailEnergy TileMeasures::*fine;
  DetailEnergy TileMeasures::*coarse;
  double effect;   ///< on the logarithm of their quotient, relative to the first pair's
  double noise;    ///< standard deviation of the finer energy, both axes, that white noise of
                   ///< variance 1 leaves in a tile, times the root of its pixels
  double scatter;  ///< of the logarithm, between tiles of neighbouring faces without noise
};

/// What each pair is good for: the first feels blur most but drowns in noise where there is little
/// detail, as in casting material, where the others are still good. The effects are those of blur
/// on the twin's tissue and casting material, the scatter is that of its layers; what noise leaves
/// was measured on pictures of nothing else.
constexpr std::array kPairs = {
    BandPair{&TileMeasures::curvature, &TileMeasures::fine, 1.0, 20.0, 0.10},
    BandPair{&TileMeasures::fine, &TileMeasures::middle, 0.25, 1.3, 0.08},
    BandPair{&TileMeasures::middle, &TileMeasures::coarse, 0.08, 0.4, 0.08}};

/// Which the estimates have in common with all tiles: what the scatter between them cannot show.
constexpr double kCommonError = 0.005;

constexpr std::size_t kLeastTiles = 4;

/// A tile whose coarse detail changed by this part, up or down, counts for six tenths.
constexpr double kContentChange = 0.4;
constexpr double kLeastLikeness = 0.1;

/// A tile whose colour changed by this part counts for six tenths in the comparison of contrast.
constexpr double kColourChange = 0.04;

/// A pair whose finer energy noise alone makes fluctuate by more than this part says nothing: where
/// there is noise alone, none of a hundred tiles shows three standard deviations of it.
constexpr double kMostFluctuation = 1.0 / 3.0;

/// Below it a tile has lost all detail: the logarithm of nothing would say no more.
constexpr double kLeastQuotient = 0.05;
constexpr double kLeastEnergy = 1e-12;

/// For the sharpness of a frame alone.
constexpr double kLeastSignal = 1.0;
constexpr double kMostWeight = 20.0;

using References = std::span<const std::shared_ptr<const FrameMeasures>>;
using Axes = double (*)(const DetailEnergy&);

double both(const DetailEnergy& energy) {
  return energy.sum();
}
double along_x(const DetailEnergy& energy) {
  return energy.along_x;
}
double along_y(const DetailEnergy& energy) {
  return energy.along_y;
}

struct Weighted {
  double value = 0.0;
  double weight = 0.0;
};

double weighted_median(std::vector<Weighted> values) {
  std::sort(values.begin(), values.end(),
            [](const Weighted& left, const Weighted& right) { return left.value < right.value; });
  double half = 0.0;
  for (const Weighted& value : values) half += 0.5 * value.weight;
  for (const Weighted& value : values) {
    half -= value.weight;
    if (half <= 0.0) return value.value;
  }
  return values.back().value;
}

/// Of the weighted median: as of a median of normally scattering values, with as many of them as
/// the weights are worth.
double standard_error(const std::vector<Weighted>& values, double middle) {
  constexpr double kSigmaOfDeviation = 1.4826;  // of the median absolute deviation
  constexpr double kMedianOfMean = 1.2533;      // sqrt(pi / 2)
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

/// A property of a tile, in the median of the references.
template <typename Property>
double typical(References references, std::size_t tile, const Property& property) {
  std::vector<double> values;
  for (const auto& reference : references) values.push_back(property(reference->tiles[tile]));
  return median(std::move(values));
}

double quotient(const TileMeasures& tile, const BandPair& pair, Axes axes) {
  return std::max(axes(tile.*pair.fine), 0.0) / std::max(axes(tile.*pair.coarse), kLeastEnergy);
}

/// How the quotient of a pair differs from what it is in the references, as a logarithm; nothing
/// when there it is nothing.
std::optional<double> change(const TileMeasures& tile, References references, std::size_t number,
                             const BandPair& pair, Axes axes) {
  const double then = typical(references, number, [&](const TileMeasures& reference) {
    return quotient(reference, pair, axes);
  });
  if (then <= 0.0) return std::nullopt;
  return std::log(std::max(quotient(tile, pair, axes) / then, kLeastQuotient));
}

/// A band's energy relative to the brightness: neither lamp nor exposure change it.
double relative_energy(const TileMeasures& tile, DetailEnergy TileMeasures::*band) {
  const double brightness = std::max(tile.brightness(), kLeastEnergy);
  return std::max((tile.*band).sum(), kLeastEnergy) / (brightness * brightness);
}

double change_of_energy(const TileMeasures& tile, References references, std::size_t number,
                        DetailEnergy TileMeasures::*band) {
  return std::log(relative_energy(tile, band) /
                  typical(references, number, [band](const TileMeasures& reference) {
                    return relative_energy(reference, band);
                  }));
}

/// 1 for no change, six tenths for one of `scale`.
double likeness_of(double change, double scale) {
  return std::exp(-0.5 * std::pow(change / scale, 2));
}

/// How alike a tile's content is to the references': 1 is the same. By the contrast of the coarse
/// detail, which a little blur leaves alone.
double likeness(const TileMeasures& tile, References references, std::size_t number) {
  return likeness_of(change_of_energy(tile, references, number, &TileMeasures::coarse),
                     kContentChange);
}

/// By the mean colours, which no blur changes.
double likeness_of_colours(const TileMeasures& tile, References references, std::size_t number) {
  double most = 0.0;
  for (std::size_t c = 0; c < tile.mean.size(); ++c) {
    const auto mean = [c](const TileMeasures& of) { return std::max(of.mean[c], kLeastEnergy); };
    most = std::max(most, std::fabs(std::log(mean(tile) / typical(references, number, mean))));
  }
  return likeness_of(most, kColourChange);
}

/// The inverse variance of the change of a pair's quotient in a tile of so many pixels; 0 when
/// noise leaves nothing of it.
double certainty(References references, std::size_t number, const BandPair& pair, int pixels) {
  const double energy = typical(references, number, [&](const TileMeasures& tile) {
    return std::max((tile.*pair.fine).sum(), kLeastEnergy);
  });
  const double noise =
      typical(references, number, [](const TileMeasures& tile) { return tile.noise; });
  const double fluctuation =
      pair.noise * noise * noise / std::sqrt(static_cast<double>(pixels)) / energy;
  if (fluctuation > kMostFluctuation) return 0.0;
  return 1.0 / (pair.scatter * pair.scatter + fluctuation * fluctuation);
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
    const double alike = likeness(tile, references, i);
    const double certain =
        certainty(references, i, pair, frame.grid.tile(static_cast<int>(i)).area());
    if (alike < kLeastLikeness || certain <= 0.0) continue;
    const auto all = change(tile, references, i, pair, &both);
    const auto x = change(tile, references, i, pair, &along_x);
    const auto y = change(tile, references, i, pair, &along_y);
    if (!all || !x || !y) continue;
    const double weight = alike * certain;
    changes.both.push_back({*all, weight});
    changes.x.push_back({*x, weight});
    changes.y.push_back({*y, weight});
    changes.x_over_y.push_back({*x - *y, weight});
  }
  return changes;
}

bool comparable(const FrameMeasures& frame, References references) {
  return !references.empty() && std::ranges::all_of(references, [&](const auto& reference) {
    return reference->grid == frame.grid;
  });
}

/// The mean of the pairs' medians, each over its effect, by the inverse of their variances.
class Combination {
 public:
  void add(const std::vector<Weighted>& changes, const BandPair& pair) {
    const double middle = weighted_median(changes);
    const double error = std::hypot(standard_error(changes, middle),
                                    kCommonError * pair.scatter / kPairs[0].scatter);
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
  return quotient(tile, kPairs[0], &both);
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
  for (const BandPair& pair : kPairs) {
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
    const double certain = certainty(references, i, kPairs[1], pixels);
    if (alike < kLeastLikeness || certain <= 0.0) continue;
    changes.push_back(
        {change_of_energy(tile, references, i, &TileMeasures::fine), alike * certain});
  }
  if (changes.size() < kLeastTiles) return std::nullopt;
  // Of energies, and contrast is an amplitude.
  return std::exp(0.5 * weighted_median(std::move(changes)));
}

}  // namespace biotomy::acquisition
