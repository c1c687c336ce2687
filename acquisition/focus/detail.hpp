#pragma once

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

/// Of all of them together.
Detail sum(const std::vector<Detail>& tiles);

}  // namespace biotomy::acquisition
