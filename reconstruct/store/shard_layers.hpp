#pragma once

#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/store/stored_shard.hpp"
#include "reconstruct/store/zarr_array.hpp"

namespace biotomy::reconstruct {

/// Layers `first` to `first + count − 1` of a shard (from 0 within it), each the upper left part of
/// `size`, CV_8UC3 or CV_16UC3; black where nothing is stored. Chunks are decoded in parallel.
/// Throws SampleError, naming the chunk that is damaged.
std::vector<cv::Mat> shard_layers(const std::optional<StoredShard>& shard, const ZarrArray& array,
                                  int first, int count, cv::Size size);

}  // namespace biotomy::reconstruct
