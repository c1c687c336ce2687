#pragma once

#include "reconstruct/export/export_request.hpp"
#include "reconstruct/store/volume.hpp"

namespace biotomy::reconstruct {

/// Writes the layers of one level as TIFFs that any reader takes: RGB in strips, deflate, no
/// predictor, one file a layer, `000001.tif` for the first layer of the level, also when a region
/// begins deeper. The resolution is the level's; the distance of the layers stands in the
/// ImageDescription as ImageJ has it.
/// The volume is gone through a row of chunks at a time, with as many files open as a chunk has
/// layers: memory holds such a row. Progress is in layers. Throws InvalidRequest, SampleError or
/// Interrupted; then nothing is left.
void export_tiff_stack(const Volume& volume, const ExportRequest& request);

}  // namespace biotomy::reconstruct
