#include "reconstruct/export/export_request.hpp"

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {

VoxelRegion exported_region(const Volume& volume, const ExportRequest& request) {
  if (request.level < 0 || request.level >= volume.levels()) {
    throw SampleError("level " + std::to_string(request.level) + ": the volume has levels 0 to " +
                      std::to_string(volume.levels() - 1));
  }
  const VoxelRegion whole = whole_level(volume, request.level);
  if (whole.z.count() == 0) {
    throw SampleError("the volume has no layers yet");
  }
  return request.region.empty() ? whole : parse_region(request.region, whole);
}

}  // namespace biotomy::reconstruct
