#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "reconstruct/export/voxel_region.hpp"
#include "reconstruct/interruption.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/volume.hpp"

namespace biotomy::reconstruct {

struct ExportRequest {
  std::filesystem::path output;  ///< a folder; must not exist, or be empty
  int level = 0;                 ///< the finest that is exported
  std::string region;            ///< of that level, as parse_region takes it; empty: all of it
  std::function<void(std::int64_t done, std::int64_t total)> progress;
  StopRequested stop;
};

/// The voxels of `request.level` that are asked for. Throws SampleError when there is no such level
/// or no layer yet, and what parse_region throws.
VoxelRegion exported_region(const Volume& volume, const ExportRequest& request);

/// Section numbers, from 1, the last included.
struct LayerNumbers {
  std::int64_t first = 0;
  std::int64_t last = 0;

  friend bool operator==(const LayerNumbers&, const LayerNumbers&) = default;
};

/// The sample's layers that are not in its volume yet, but lie as images behind those that are;
/// none where the request is for others alone. An export, which is made of the volume, leaves them
/// out. Throws SampleError when there is no such level, and what parse_region throws.
std::optional<LayerNumbers> layers_left_out(const SampleFolder& sample, const Volume& volume,
                                            const ExportRequest& request);

}  // namespace biotomy::reconstruct
