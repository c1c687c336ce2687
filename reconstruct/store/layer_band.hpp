#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::reconstruct {

/// Neighbouring layer files of a sample, from which regions are read together.
class LayerBand {
 public:
  /// Section numbers `first` (from 1) to `first + count − 1`. Throws SampleError, naming the file,
  /// when one is missing or is not as large as the sample.
  LayerBand(const SampleFolder& sample, std::int64_t first, std::int64_t count);

  /// The same region of each layer. Layers are read in parallel; not for two threads at once.
  std::vector<cv::Mat> read(const cv::Rect& region) const;

 private:
  std::vector<std::filesystem::path> paths_;
  std::vector<std::unique_ptr<LayerImageReader>> readers_;  ///< of the first of them
};

}  // namespace biotomy::reconstruct
