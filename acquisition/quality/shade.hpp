#pragma once

#include <opencv2/core/mat.hpp>

namespace biotomy::acquisition {

/// 255 where something stands in the light, CV_8UC1: where all colours are darker, or all brighter,
/// by the same part. Another tissue has other colours; a shadow has not, and nor has what a lens
/// cap, a hose or dead pixels make black. `now` and `before` are light grids (CV_32FC3, see
/// light_grid) of two layers, the change of the light between them taken out of the former. Of each
/// cell's change the median of 5 × 5 counts, which leaves out what moves or comes up; it shows
/// where it is more than 8 %.
cv::Mat shaded(const cv::Mat& now, const cv::Mat& before);

}  // namespace biotomy::acquisition
