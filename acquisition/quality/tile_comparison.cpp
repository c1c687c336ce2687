#include "acquisition/quality/tile_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "acquisition/quality/median.hpp"

namespace biotomy::acquisition {
namespace {

/// A tile whose coarse detail changed by this part, up or down, counts for six tenths.
constexpr double kContentChange = 0.4;

/// A tile whose colour changed by this part counts for six tenths in the comparison of contrast.
constexpr double kColourChange = 0.04;

/// A pair whose finer energy noise alone makes fluctuate by more than this part says nothing: where
/// there is noise alone, none of a hundred tiles shows three standard deviations of it.
constexpr double kMostFluctuation = 1.0 / 3.0;

/// Below it a tile has lost all detail: the logarithm of nothing would say no more.
constexpr double kLeastQuotient = 0.05;
constexpr double kLeastEnergy = 1e-12;

/// A property of a tile, in the median of the references.
template <typename Property>
double typical(References references, std::size_t tile, const Property& property) {
  std::vector<double> values;
  for (const auto& reference : references) values.push_back(property(reference->tiles[tile]));
  return median(std::move(values));
}

/// A band's energy relative to the brightness: neither lamp nor exposure change it.
double relative_energy(const TileMeasures& tile, DetailBand band) {
  const double brightness = std::max(tile.brightness(), kLeastEnergy);
  return std::max(tile.detail(band).sum(), kLeastEnergy) / (brightness * brightness);
}

/// 1 for no change, six tenths for one of `scale`.
double likeness_of(double change, double scale) {
  return std::exp(-0.5 * std::pow(change / scale, 2));
}

}  // namespace

double both_axes(const DetailEnergy& energy) {
  return energy.sum();
}
double along_x(const DetailEnergy& energy) {
  return energy.along_x;
}
double along_y(const DetailEnergy& energy) {
  return energy.along_y;
}

bool comparable(const FrameMeasures& frame, References references) {
  return !references.empty() && std::ranges::all_of(references, [&](const auto& reference) {
    return reference->grid == frame.grid;
  });
}

double quotient(const TileMeasures& tile, const BandPair& pair, Axes axes) {
  return std::max(axes(tile.detail(pair.fine)), 0.0) /
         std::max(axes(tile.detail(pair.coarse)), kLeastEnergy);
}

std::optional<double> change_of_quotient(const TileMeasures& tile, References references,
                                         std::size_t number, const BandPair& pair, Axes axes) {
  const double then = typical(references, number, [&](const TileMeasures& reference) {
    return quotient(reference, pair, axes);
  });
  if (then <= 0.0) return std::nullopt;
  return std::log(std::max(quotient(tile, pair, axes) / then, kLeastQuotient));
}

double change_of_energy(const TileMeasures& tile, References references, std::size_t number,
                        DetailBand band) {
  return std::log(relative_energy(tile, band) /
                  typical(references, number, [band](const TileMeasures& reference) {
                    return relative_energy(reference, band);
                  }));
}

double likeness_of_detail(const TileMeasures& tile, References references, std::size_t number) {
  return likeness_of(change_of_energy(tile, references, number, DetailBand::coarse),
                     kContentChange);
}

double likeness_of_colours(const TileMeasures& tile, References references, std::size_t number) {
  double most = 0.0;
  for (std::size_t c = 0; c < tile.mean.size(); ++c) {
    const auto mean = [c](const TileMeasures& of) { return std::max(of.mean[c], kLeastEnergy); };
    most = std::max(most, std::fabs(std::log(mean(tile) / typical(references, number, mean))));
  }
  return likeness_of(most, kColourChange);
}

double certainty(References references, std::size_t number, const BandPair& pair, int pixels) {
  const double energy = typical(references, number, [&](const TileMeasures& tile) {
    return std::max(tile.detail(pair.fine).sum(), kLeastEnergy);
  });
  const double noise =
      typical(references, number, [&](const TileMeasures& tile) { return tile.noise[pair.fine]; });
  const double fluctuation =
      pair.fluctuation * 2.0 * noise / std::sqrt(static_cast<double>(pixels)) / energy;
  if (fluctuation > kMostFluctuation) return 0.0;
  return 1.0 / (pair.scatter * pair.scatter + fluctuation * fluctuation);
}

}  // namespace biotomy::acquisition
