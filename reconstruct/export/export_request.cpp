#include "reconstruct/export/export_request.hpp"

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

/// Where there are so many layers.
VoxelRegion wanted_region(const Volume& volume, const ExportRequest& request, std::int64_t layers) {
  if (request.level < 0 || request.level >= volume.levels()) {
    throw SampleError("level " + std::to_string(request.level) + ": the volume has levels 0 to " +
                      std::to_string(volume.levels() - 1));
  }
  const VoxelRegion whole = whole_level(volume, request.level, layers);
  if (whole.z.count() == 0) {
    throw SampleError("the volume has no layers yet");
  }
  return request.region.empty() ? whole : parse_region(request.region, whole);
}

}  // namespace

VoxelRegion exported_region(const Volume& volume, const ExportRequest& request) {
  return wanted_region(volume, request, volume.layers_present());
}

std::optional<LayerNumbers> layers_left_out(const SampleFolder& sample, const Volume& volume,
                                            const ExportRequest& request) {
  const std::int64_t present = volume.layers_present();
  const std::int64_t last = present + sample.layers_on_disk(present + 1);
  if (last == present) {
    return std::nullopt;
  }
  // Of a region that ends in the volume nothing is missing.
  const VoxelRegion wanted = wanted_region(volume, request, last);
  if (wanted.z.end * volume.level(request.level).factor.z <= present) {
    return std::nullopt;
  }
  return LayerNumbers{present + 1, last};
}

}  // namespace biotomy::reconstruct
