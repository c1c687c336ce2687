#pragma once

#include <opencv2/core/mat.hpp>

namespace biotomy::reconstruct {

/// Throws InvalidRequest unless it is what our writers of pictures and films read: CV_8UC3 or
/// CV_16UC3 with at least one pixel.
void require_rgb_picture(const cv::Mat& picture);

}  // namespace biotomy::reconstruct
