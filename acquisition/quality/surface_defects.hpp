#pragma once

#include <opencv2/core/mat.hpp>

#include "acquisition/quality/clipping_levels.hpp"
#include "acquisition/quality/light_change.hpp"
#include "acquisition/quality/surface_record.hpp"

namespace biotomy::acquisition {

/// What lies on a face or shines from it, as parts of the frame.
struct SurfaceDefects {
  double debris = 0.0;
  double frost = 0.0;
  double glare = 0.0;
  double shade = 0.0;
  double arrived = 0.0;  ///< is new over an area larger than a speck: tissue, not casting material
};

/// Finds what a grind cannot have uncovered. `image` is the frame of which `now` is the print
/// and `clipping` the levels, `record` has a surface of a frame of its size, `light` is the change
/// of light since that surface's layer; it is taken out first.
///
/// Debris: cells of the thumbnail that are foreign. A cell is foreign when one of its colours lies
/// outside all that the layer before has within two cells, so that an edge that moves is not, and
/// when the recent layers have no such colour nearby either (see KnownColours), so that tissue
/// which comes up from below is not. Nor is what is connected over more than 0.8 % of the frame. A
/// speck smaller than a cell counts as one. Nothing is known of the colour of debris or tissue.
///
/// Glare: those of the foreign cells in which at least 1 pixel in 16 is at full scale, or
/// clipped, in all colours.
///
/// Frost: a veil that makes colours paler. On the light grid the opacity of a white veil that would
/// explain a cell is the least of (now − before)/(1 − before) over the colours that are not bright
/// already; 0 where these differ by more than 0.3 of it, as between two tissues, or where it hides
/// all. Of it the median of 5 × 5 cells, which leaves out what moves or comes up: the part of the
/// frame where that is above 0.07. Foreign cells there are frost and not debris.
///
/// Shade: see shaded().
SurfaceDefects find_surface_defects(const cv::Mat& image, const ClippingLevels& clipping,
                                    const SurfacePrint& now, const SurfaceRecord& record,
                                    const LightChange& light);

}  // namespace biotomy::acquisition
