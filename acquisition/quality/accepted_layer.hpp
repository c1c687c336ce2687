#pragma once

#include <cstdint>

#include "acquisition/quality/assessment.hpp"

namespace biotomy::acquisition {

/// A layer is accepted and stored: from what was found of its frame, `expectation` knows what the
/// next ones are compared with. `flagged`: it lacks sharpness, and is no measure of it.
void accept_layer(std::int64_t layer, const Assessment& assessment, bool flagged,
                  FrameExpectation& expectation);

}  // namespace biotomy::acquisition
