#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/pyramid.hpp"
#include "reconstruct/store/volume_layout.hpp"

namespace biotomy::reconstruct {

/// What there is of a sample on disk.
struct SampleSummary {
  std::int64_t layer_images = 0;
  std::uint64_t layer_bytes = 0;
  bool has_volume = false;
  std::int64_t layers_in_volume = 0;
  std::uint64_t volume_bytes = 0;
  std::int64_t layers_in_sections = 0;  ///< those in the volume, and the images that follow them
  VolumeLayout layout;                  ///< of the volume, if there is one
  std::vector<PyramidLevel> levels;     ///< likewise
  std::optional<std::string> volume_misfit;  ///< as misfit() tells it
};

/// Looks at names and sizes and at the volume's metadata, not into images or chunks.
/// Throws SampleError.
SampleSummary summarise(const SampleFolder& sample);

}  // namespace biotomy::reconstruct
