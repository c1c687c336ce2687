#pragma once

#include <filesystem>

#include "reconstruct/bricks/layer_tail.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/volume.hpp"

namespace biotomy::tools {

/// A sample as sections are cut from it: its volume, and the layers that are not in the volume yet.
struct OpenedSample {
  /// Throws SampleError, also when there is no layer yet.
  explicit OpenedSample(const std::filesystem::path& path);
  OpenedSample(const OpenedSample&) = delete;
  OpenedSample& operator=(const OpenedSample&) = delete;

  reconstruct::SampleFolder folder;
  reconstruct::Volume volume;
  reconstruct::LayerTail tail;
};

}  // namespace biotomy::tools
