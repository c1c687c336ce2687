#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "acquisition/quality/frame_measures.hpp"

namespace biotomy::acquisition {

/// Two neighbouring bands of a tile's detail. Blur takes more of the finer.
struct BandPair {
  DetailBand fine;
  DetailBand coarse;
  double effect;       ///< on the logarithm of their quotient, relative to the first pair's
  double fluctuation;  ///< standard deviation of the finer energy in a tile of noise alone, as a
                       ///< part of that energy, times the root of its pixels
  double scatter;      ///< of the logarithm, between tiles of neighbouring faces without noise
};

/// What each pair is good for: the first feels blur most but drowns in noise where there is little
/// detail, as in casting material, where the others are still good. The effects are those of blur
/// on the twin's tissue and casting material, the scatter is that of its layers; what noise leaves
/// was measured on pictures of nothing else.
inline constexpr std::array kBandPairs = {
    BandPair{DetailBand::curvature, DetailBand::fine, 1.0, 1.667, 0.10},
    BandPair{DetailBand::fine, DetailBand::middle, 0.25, 3.467, 0.08},
    BandPair{DetailBand::middle, DetailBand::coarse, 0.08, 4.267, 0.08}};

/// A tile that is less like its references counts for nothing.
inline constexpr double kLeastLikeness = 0.1;

/// Frames of one size, of which the median of each tile is what a tile is compared with.
using References = std::span<const std::shared_ptr<const FrameMeasures>>;

/// The part of an energy that counts.
using Axes = double (*)(const DetailEnergy&);
double both_axes(const DetailEnergy& energy);
double along_x(const DetailEnergy& energy);
double along_y(const DetailEnergy& energy);

/// Whether there are references, all of the frame's size.
bool comparable(const FrameMeasures& frame, References references);

double quotient(const TileMeasures& tile, const BandPair& pair, Axes axes);

/// How the quotient of a pair differs from what it is in the references, as a logarithm; nothing
/// when there it is nothing.
std::optional<double> change_of_quotient(const TileMeasures& tile, References references,
                                         std::size_t number, const BandPair& pair, Axes axes);

/// Of a band's energy relative to the brightness, which neither lamp nor exposure change, as a
/// logarithm.
double change_of_energy(const TileMeasures& tile, References references, std::size_t number,
                        DetailBand band);

/// How alike a tile's content is to the references', up to 1: by the contrast of the coarse detail,
/// which a little blur leaves alone.
double likeness_of_detail(const TileMeasures& tile, References references, std::size_t number);

/// By the mean colours, which no blur changes.
double likeness_of_colours(const TileMeasures& tile, References references, std::size_t number);

/// The inverse variance of the change of a pair's quotient in a tile of so many pixels; 0 when
/// noise leaves nothing of it.
double certainty(References references, std::size_t number, const BandPair& pair, int pixels);

}  // namespace biotomy::acquisition
