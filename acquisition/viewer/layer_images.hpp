#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <oneapi/tbb/task_arena.h>
#include <opencv2/core/mat.hpp>

#include "acquisition/http/message.hpp"
#include "acquisition/viewer/layer_records.hpp"
#include "acquisition/viewer/live_sample.hpp"
#include "reconstruct/store/lru_map.hpp"

namespace biotomy::acquisition {

/// Pixels of a side of a tile.
inline constexpr int kLayerTile = 512;

/// `image` reduced by 2^`shift`: each pixel is the mean of the 2^shift × 2^shift pixels that there
/// are of it.
cv::Mat reduced(const cv::Mat& image, int shift);

/// The images of layers as a page looks at them: whole and small, tile by tile, and as a map of
/// sharpness. An image is decoded once for a while; JPEGs are kept. Safe for many threads.
class LayerImages {
 public:
  /// All outlive it. What is decoded takes `decoded_bytes` at most, or one image.
  LayerImages(LiveSample& live, const LayerRecords& records, tbb::task_arena& arena,
              std::size_t decoded_bytes);

  /// Each throws InvalidRequest, Refusal, SampleError, and Interrupted when the client has left.
  ApiResponse image(std::int64_t layer, const ApiRequest& request);
  ApiResponse tile(std::int64_t layer, int shift, int column, int row, const ApiRequest& request);
  ApiResponse sharpness(std::int64_t layer, const ApiRequest& request);

 private:
  struct Place;
  using Bytes = std::shared_ptr<const std::string>;
  using Make = std::function<std::string(const Place&)>;

  Place place_of(std::int64_t layer) const;
  cv::Mat decoded(const Place& place);
  cv::Mat region(const Place& place, const cv::Rect& wanted);
  ApiResponse kept_or_made(std::int64_t layer, const std::string& what,
                           const std::string& content_type, const ApiRequest& request,
                           const Make& make);

  LiveSample& live_;
  const LayerRecords& records_;
  tbb::task_arena& arena_;
  std::mutex mutex_;
  reconstruct::LruMap<std::string, cv::Mat> decoded_;
  reconstruct::LruMap<std::string, Bytes> made_;
};

}  // namespace biotomy::acquisition
