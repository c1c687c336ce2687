#pragma once

#include <opencv2/core/mat.hpp>

namespace biotomy::acquisition {

/// How sharp an image is: a number without a unit, to be compared only between images of the same
/// scene, as along a focus sweep.
///
/// The mean energy of the brightness gradient, E[gx² + gy²], divided by the squared mean
/// brightness, so that neither exposure nor lamp changes it. Gradients are central differences of
/// the image smoothed by a Gaussian of σ = 1 pixel, without which pixel noise would count as
/// detail. After Tenenbaum's gradient measure as compared by Groen, Young and Ligthart, "A
/// comparison of different focus functions for use in autofocus algorithms", Cytometry 6 (1985)
/// 81-91.
///
/// `image` is CV_8UC3 or CV_16UC3, R G B. A black or empty image has sharpness 0.
double sharpness(const cv::Mat& image);

/// The same over the brightness alone (CV_32FC1, 0 to 1).
double sharpness_of_brightness(const cv::Mat& brightness);

/// Brightness as CV_32FC1, 0 to 1, of an R G B image of 8 or 16 bits.
cv::Mat brightness_of(const cv::Mat& image);

}  // namespace biotomy::acquisition
