#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "acquisition/quality/frame_measures.hpp"

namespace biotomy::acquisition {

/// How much detail a part of a frame shows: the energy of its brightness' gradient, without noise,
/// by the frame's squared mean brightness, so that neither lamp nor exposure changes it.
struct Detail {
  double energy = 0.0;
  double error = 0.0;  ///< its standard deviation by noise alone
};

/// Of each tile. Sums the levels `fine` and `middle`: the finest waves say most near the focus and
/// nothing far from it, and where there is only fog, `coarse` ones still tell the way. See
/// docs/quality.md for the comparison.
std::vector<Detail> detail_of_tiles(const FrameMeasures& measures);

/// The numbers of those tiles that show detail in at least one of the frames: what the others would
/// add to a sum is noise.
std::vector<std::size_t> telling_tiles(std::span<const std::vector<Detail>> frames);

/// Of these tiles together.
Detail sum(const std::vector<Detail>& tiles, std::span<const std::size_t> numbers);

}  // namespace biotomy::acquisition
