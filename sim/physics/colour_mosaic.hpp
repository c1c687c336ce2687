#pragma once

#include <opencv2/core/mat.hpp>

namespace biotomy::sim {

/// What a camera with one chip makes of `photograph`, CV_8UC3 or CV_16UC3, R, G, B, at least 2 × 2
/// pixels: of each pixel one colour was seen, in even rows R G R G …, in odd ones G B G B … (Bayer,
/// US patent 3971065), and the others are the means of the neighbours that saw them. So is its
/// noise no longer white.
void interpolate_mosaic(cv::Mat& photograph);

}  // namespace biotomy::sim
