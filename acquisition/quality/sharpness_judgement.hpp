#pragma once

#include <cstdint>

#include "acquisition/quality/judgement.hpp"
#include "acquisition/quality/sharpness_record.hpp"

namespace biotomy::acquisition {

/// Whether a frame of `layer` is as sharp as it could be (`sharpness_ratio`), and so along each
/// axis (`sharpness_along_axis`, of the less sharp: a movement blurs one of them), and whether it
/// shows fine detail at all where the last layers do (`fine_contrast`). The result has its measures
/// already.
///
/// After a focus search at this layer the search's sharpest frame decides: it shows the same face,
/// whatever that contains. Otherwise the last accepted layers do: what they contain is nearly the
/// same. A slow drift, with which they would go along, shows in the ratio to the last search's
/// peak, which the focus follows by. After a search the record has a say too
/// (`sharpness_to_record`), with a wide limit: a search that ended on a wrong peak finds its own
/// frames sharp.
///
/// Whether the frame still has the contrast of fine detail that it must have, whatever else was
/// found: false also when that cannot be told.
///
/// Limits are lowered by what the ratio may be wrong by: a small frame, or one with little detail,
/// has the benefit of the doubt.
bool judge_sharpness(const SharpnessRecord& record, std::int64_t layer,
                     const QualityThresholds& thresholds, Judgement& judgement);

}  // namespace biotomy::acquisition
