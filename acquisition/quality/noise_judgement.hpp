#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "acquisition/quality/assessment.hpp"
#include "acquisition/quality/judgement.hpp"
#include "acquisition/quality/sharpness_record.hpp"

namespace biotomy::acquisition {

/// Expresses the frame's measures by what is known of the camera's noise. Where this layer's focus
/// was searched, the frame and the search's sharpest one tell the noise anew: it is noted as
/// metrics that always pass, and `record` learns it at once when it knew none; else only once
/// the frame was accepted, since what spoils a frame may pass for noise.
void judge_noise(std::int64_t layer, SharpnessRecord& record, Judgement& judgement);

/// As the metrics of a frame tell it; nothing when they do not.
std::optional<CameraNoise> noise_noted(const std::vector<Metric>& metrics);

}  // namespace biotomy::acquisition
