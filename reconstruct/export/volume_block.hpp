#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/export/voxel_region.hpp"
#include "reconstruct/store/volume.hpp"

namespace biotomy::reconstruct {

/// The voxels of a region of a level, layer by layer, CV_8UC3 or CV_16UC3, R G B. Reads the chunks
/// that the region touches one after the other. Throws what Volume::read_chunk throws.
std::vector<cv::Mat> read_block(const Volume& volume, int level, const VoxelRegion& region);

}  // namespace biotomy::reconstruct
