#pragma once

#include <oneapi/tbb/task_arena.h>

#include "acquisition/http/message.hpp"
#include "acquisition/viewer/live_sample.hpp"

namespace biotomy::acquisition {

/// The most pixels of a picture that is answered at once: what is larger is an export.
inline constexpr std::int64_t kMostPixelsAtOnce = 32'000'000;

/// Throws Refusal where there is no sample or, with 409, no layer yet; what LiveSample::look
/// throws.
std::shared_ptr<const SampleView> look_at_layers(LiveSample& live);

/// Sections of a sample, cut while somebody waits: /section and /section/outline. Safe for many
/// threads.
class SectionPictures {
 public:
  /// Both outlive it. What is sampled in the arena's threads does not take others.
  SectionPictures(LiveSample& live, tbb::task_arena& arena) : live_(live), arena_(arena) {}

  /// The picture, with its record in the header Biotomy-Section. Throws InvalidRequest,
  /// SampleError, Refusal; Interrupted when the client has left or it took too long.
  ApiResponse picture(const ApiRequest& request) const;

  /// The record alone, without looking at a pixel. Throws likewise.
  ApiResponse outline(const ApiRequest& request) const;

 private:
  LiveSample& live_;
  tbb::task_arena& arena_;
};

}  // namespace biotomy::acquisition
