#pragma once

#include <optional>

#include "acquisition/job/job_states.hpp"
#include "acquisition/settings/ladder_settings.hpp"

namespace biotomy::acquisition {

/// What to do after the `attempts`-th frame of a layer, from 1, was rejected: take it again, focus
/// again, clear the face again. Nothing when no attempt is left, or when the last two frames,
/// `unchanged` in a row, agree that the face is still the one before: no photograph mends that.
std::optional<JobEvent> after_rejection(int attempts, int unchanged,
                                        const LadderSettings& settings);

}  // namespace biotomy::acquisition
