#include "acquisition/quality/sharpness_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace biotomy::acquisition {
namespace {

constexpr double kLeastSignal = 1.0;  ///< to noise, of a tile that counts
constexpr double kMostWeight = 20.0;
constexpr std::size_t kLeastTiles = 4;

/// Below it a tile has lost all detail: the logarithm of nothing would say no more.
constexpr double kLeastRatio = 1e-3;

double quotient(double curvature, double gradient) {
  return gradient > 0.0 ? std::max(curvature, 0.0) / gradient : 0.0;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
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

/// A property of a tile, in the median of the references that have it; 0 when none does.
template <typename Property>
double typical(std::span<const std::shared_ptr<const FrameMeasures>> references, std::size_t tile,
               const Property& property) {
  std::vector<double> values;
  for (const auto& reference : references) values.push_back(property(reference->tiles[tile]));
  return values.empty() ? 0.0 : median(std::move(values));
}

/// Of a tile's property to what it is in the references; nothing when it is nothing there.
std::optional<double> logarithm_of_ratio(
    const FrameMeasures& frame, std::span<const std::shared_ptr<const FrameMeasures>> references,
    std::size_t tile, double (*property)(const TileMeasures&)) {
  const double then = typical(references, tile, property);
  if (then <= 0.0) return std::nullopt;
  return std::log(std::max(property(frame.tiles[tile]) / then, kLeastRatio));
}

SharpnessComparison::Estimate estimate(const std::vector<Weighted>& logarithms) {
  const double middle = weighted_median(logarithms);
  return {std::exp(middle), standard_error(logarithms, middle)};
}

}  // namespace

double sharpness(const TileMeasures& tile) {
  return quotient(tile.curvature.sum(), tile.fine.sum());
}

double sharpness_along_x(const TileMeasures& tile) {
  return quotient(tile.curvature.along_x, tile.fine.along_x);
}

double sharpness_along_y(const TileMeasures& tile) {
  return quotient(tile.curvature.along_y, tile.fine.along_y);
}

double sharpness(const FrameMeasures& frame) {
  std::vector<Weighted> tiles;
  for (const TileMeasures& tile : frame.tiles) {
    const double signal = tile.signal_to_noise();
    if (signal > kLeastSignal) tiles.push_back({sharpness(tile), std::min(signal, kMostWeight)});
  }
  return tiles.empty() ? 0.0 : weighted_median(std::move(tiles));
}

std::optional<SharpnessComparison> compare_sharpness(
    const FrameMeasures& frame, std::span<const std::shared_ptr<const FrameMeasures>> references,
    double limit) {
  for (const auto& reference : references) {
    if (reference->grid != frame.grid) return std::nullopt;
  }
  std::vector<Weighted> ratios;    // logarithms, as the next
  std::vector<Weighted> x_over_y;  // of the ratios along the axes
  for (std::size_t i = 0; i < frame.tiles.size(); ++i) {
    const double signal =
        typical(references, i, [](const TileMeasures& tile) { return tile.signal_to_noise(); });
    if (signal <= kLeastSignal) continue;
    const double weight = std::min(signal, kMostWeight);
    const auto ratio = logarithm_of_ratio(frame, references, i, &sharpness);
    const auto along_x = logarithm_of_ratio(frame, references, i, &sharpness_along_x);
    const auto along_y = logarithm_of_ratio(frame, references, i, &sharpness_along_y);
    if (!ratio || !along_x || !along_y) continue;
    ratios.push_back({*ratio, weight});
    x_over_y.push_back({*along_x - *along_y, weight});
  }
  if (ratios.size() < kLeastTiles) return std::nullopt;
  SharpnessComparison comparison;
  comparison.ratio = estimate(ratios);
  comparison.anisotropy = estimate(x_over_y);
  if (comparison.anisotropy.value > 1.0) {
    comparison.anisotropy.value = 1.0 / comparison.anisotropy.value;
  }
  comparison.tiles = static_cast<int>(ratios.size());
  comparison.below =
      static_cast<int>(std::count_if(ratios.begin(), ratios.end(), [&](const Weighted& tile) {
        return std::exp(tile.value) < limit;
      }));
  return comparison;
}

}  // namespace biotomy::acquisition
