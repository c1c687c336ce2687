#pragma once

#include "acquisition/viewer/live_sample.hpp"
#include "acquisition/viewer/picture_task.hpp"
#include "acquisition/viewer/section_query.hpp"

namespace biotomy::acquisition {

/// What GET /api/v1/section asks for, made to fit. Throws InvalidRequest, and SampleError where the
/// plane does not cut the sample; Refusal where there is nothing to cut.
PictureTask section_task(LiveSample& live, const Query& query);

}  // namespace biotomy::acquisition
