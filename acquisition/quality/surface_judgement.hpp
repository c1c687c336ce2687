#pragma once

#include <opencv2/core/mat.hpp>

#include "acquisition/quality/clipping_levels.hpp"
#include "acquisition/quality/judgement.hpp"
#include "acquisition/quality/surface_record.hpp"

namespace biotomy::acquisition {

/// Whether the block stands where it stood (`shift`, pixels, with `shift_x` and `shift_y`), and
/// whether the face is bare: the parts of the frame that `debris`, `frost` and `glare` cover.
/// `clipping` are the frame's levels. Nothing is judged without a layer before. The result has its
/// surface and its light already.
///
/// A block that moved is the truth about the sample, and another photograph does not mend it. The
/// frame is rejected all the same: a block that came loose must not be ground on unseen, so the
/// ladder ends in a pause.
void judge_surface(const cv::Mat& image, const ClippingLevels& clipping,
                   const SurfaceRecord& surfaces, const QualityThresholds& thresholds,
                   Judgement& judgement);

}  // namespace biotomy::acquisition
