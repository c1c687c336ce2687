#pragma once

#include <opencv2/core/mat.hpp>

namespace biotomy::tests {

/// How much two photographs differ beyond their noise: the mean absolute difference of their
/// colours, in levels, after each was smoothed over 3 × 3 pixels. Anatomy changes over more pixels
/// than that, noise does not.
double face_difference(const cv::Mat& one, const cv::Mat& other);

}  // namespace biotomy::tests
