#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "acquisition/viewer/live_sample.hpp"
#include "acquisition/viewer/picture_task.hpp"
#include "acquisition/viewer/section_query.hpp"
#include "reconstruct/store/lru_map.hpp"

namespace biotomy::acquisition {

/// Rotations and translations as a page plays them: /series/frames and /series/frame. Safe for many
/// threads.
class SeriesPictures {
 public:
  /// `live` outlives it.
  explicit SeriesPictures(LiveSample& live) : live_(live) {}

  /// What frames there are. Throws InvalidRequest, Refusal.
  ApiResponse frames(const ApiRequest& request) const;

  /// The section of one frame. Made to fit, all frames have one pixel size, with which the largest
  /// fits. Throws likewise, SampleError where the frame's plane does not cut the sample, and
  /// Interrupted when the client has left or it took too long.
  PictureTask frame_task(const ApiRequest& request) const;

 private:
  struct Plan;
  std::shared_ptr<const Plan> plan(const ApiRequest& request, const SampleView& view) const;

  LiveSample& live_;
  mutable std::mutex mutex_;
  mutable reconstruct::LruMap<std::string, std::shared_ptr<const Plan>> plans_{4};
};

}  // namespace biotomy::acquisition
