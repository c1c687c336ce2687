#pragma once

#include <opencv2/core/mat.hpp>

namespace biotomy::acquisition {

/// Pixels along a side of a cell, of which a thumbnail has one value.
inline constexpr int kCell = 8;

/// A frame in small: the mean colours of its cells of 8 × 8 pixels, CV_32FC3, R G B of full scale.
/// Noise is an eighth of a pixel's in it, focus and movement of a few pixels hardly show: what is
/// left is light, colour and what lies on the face.
///
/// `image` is CV_8UC3 or CV_16UC3. Up to 7 columns and rows at its right and lower edge are left
/// over. Empty when it is smaller than a cell. One pass; the time depends on the size alone.
cv::Mat take_thumbnail(const cv::Mat& image);

}  // namespace biotomy::acquisition
