#pragma once

#include <string>

#include "acquisition/viewer/live_sample.hpp"

namespace biotomy::acquisition {

/// The JSON of GET /api/v1/sample. `committed`: layers that are never taken again.
std::string sample_json(const SampleView& view, std::int64_t committed);

}  // namespace biotomy::acquisition
