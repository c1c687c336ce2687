#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>

#include <opencv2/core/mat.hpp>

#include "acquisition/records/volume_feed.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/volume_layout.hpp"

namespace biotomy::acquisition {

/// The world as far as it is not a device: the calendar and the disk. Passed in, so that a test
/// decides them.
struct Surroundings {
  std::function<std::chrono::system_clock::time_point()> wall_clock;
  std::function<std::uintmax_t(const std::filesystem::path&)> free_bytes;
  /// Called from any thread.
  std::function<reconstruct::PublishLayer(const std::filesystem::path&, const cv::Mat&,
                                          const reconstruct::LayerPosition&,
                                          const reconstruct::LayerFormat&)>
      prepare_layer;
  std::function<cv::Mat(const std::filesystem::path&)> read_layer;
  std::function<VolumeFeed::Append(const reconstruct::SampleFolder&,
                                   const reconstruct::VolumeLayout&)>
      open_volume;
};

Surroundings real_surroundings();

}  // namespace biotomy::acquisition
