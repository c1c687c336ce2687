#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "reconstruct/export/voxel_region.hpp"
#include "reconstruct/interruption.hpp"
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

}  // namespace biotomy::reconstruct
