#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/store/pyramid.hpp"

namespace biotomy::reconstruct {

/// The axes along which a level has half the voxels of the level before.
struct HalvedAxes {
  bool x = false;
  bool y = false;
  bool z = false;
};
HalvedAxes halved_axes(const LevelFactor& before, const LevelFactor& level);

/// The means of neighbouring voxels: 2 along each halved axis, pairs from the first layer, row and
/// column on; at an odd far end the last voxel stands alone. `layers` are of one size, CV_8UC3 or
/// CV_16UC3. A mean is taken of all its voxels at once and rounded to nearest, a half upwards.
std::vector<cv::Mat> level_mean(const std::vector<cv::Mat>& layers, const HalvedAxes& axes);

}  // namespace biotomy::reconstruct
