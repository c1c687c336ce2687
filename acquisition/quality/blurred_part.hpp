#pragma once

#include <memory>
#include <optional>
#include <span>

#include "acquisition/quality/frame_measures.hpp"

namespace biotomy::acquisition {

/// The part of the frame, as the largest connected group of its tiles, that is clearly less sharp
/// than the references, frames of the same size: under a drop on the lens, under breath or fog, or
/// where the face is tilted. Medians over all tiles don't see it. Nothing when fewer than four
/// tiles can be compared, or when tiles have fewer than 400 pixels.
///
/// A tile counts when the three quotients of compare_sharpness, combined by their certainty, in the
/// median over it and the tiles around it, are below three quarters of the references' median, and
/// so far below one that chance does not explain it. Only tiles whose mean colour stayed the same
/// are compared: no blur changes that, while the contrast of coarse detail, by which
/// compare_sharpness tells content, falls with a strong blur.
std::optional<double> blurred_part(
    const FrameMeasures& frame, std::span<const std::shared_ptr<const FrameMeasures>> references);

}  // namespace biotomy::acquisition
