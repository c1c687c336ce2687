#pragma once

#include <opencv2/imgproc.hpp>

namespace biotomy::tests {

/// RGB for OpenCV's codecs, which mean BGR, and back.
inline cv::Mat swapped_colours(const cv::Mat& picture) {
  cv::Mat swapped;
  cv::cvtColor(picture, swapped, cv::COLOR_RGB2BGR);
  return swapped;
}

}  // namespace biotomy::tests
