#pragma once

#include <filesystem>

#include "reconstruct/bricks/layer_tail.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/volume.hpp"

namespace biotomy::reconstruct {

/// A sample as sections are cut from it: its volume, and the layers that are not in the volume yet.
struct OpenedSample {
  /// Throws SampleError.
  explicit OpenedSample(const std::filesystem::path& path);
  OpenedSample(const OpenedSample&) = delete;
  OpenedSample& operator=(const OpenedSample&) = delete;

  /// Throws SampleError when there is no layer yet.
  void require_layers() const;

  SampleFolder folder;
  Volume volume;
  LayerTail tail;
};

}  // namespace biotomy::reconstruct
