#pragma once

#include <string>

#include "reconstruct/export/export_request.hpp"
#include "reconstruct/store/volume.hpp"

namespace biotomy::reconstruct {

/// Writes a volume as OME-Zarr 0.4 (Zarr v2), which older readers take: axes c, z, y, x, one colour
/// and 64 × 64 × 64 voxels in a chunk, Blosc with LZ4, "/" between the numbers of a chunk's name,
/// scale and translation of every level, omero's colours. From `request.level` on all levels are
/// there; a region is cut out of each, grown to whole voxels of that level, and keeps its place in
/// the sample's frame. Chunks without anything but 0 are not stored.
/// Memory holds a few chunks for each thread. Progress is in chunks. Throws InvalidRequest,
/// SampleError or Interrupted; then nothing is left.
void export_ome_zarr_04(const Volume& volume, const std::string& name,
                        const ExportRequest& request);

}  // namespace biotomy::reconstruct
