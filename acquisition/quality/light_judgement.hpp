#pragma once

#include <array>

#include "acquisition/quality/judgement.hpp"
#include "acquisition/quality/surface_record.hpp"

namespace biotomy::acquisition {

// Names of the metrics in which the journal keeps the casting material's colour, R, G, B of full
// scale; it is asked for the first layer's when a job goes on.
inline constexpr std::array<const char*, 3> kCastingMetrics{"casting_red", "casting_green",
                                                            "casting_blue"};

/// The light of a frame whose surface this is, measured against the layers before.
FrameLight find_light(const SurfacePrint& surface, const SurfaceRecord& surfaces);

/// Whether the light is what it was: its strength (`brightness`, the ratio to the last layers' less
/// 1), its evenness (`evenness`, by how much the ratio differs over the frame), its colour
/// (`colour_cast`, by how much the ratio differs between the colours); and, so that a slow drift is
/// not followed, the casting material's brightness and colour against the first layer's
/// (`brightness_drift`, `colour_drift`). What is not sure is not judged: without a layer before,
/// without enough that is steady. The result has its light already.
void judge_light(const SurfaceRecord& surfaces, const QualityThresholds& thresholds,
                 Judgement& judgement);

}  // namespace biotomy::acquisition
