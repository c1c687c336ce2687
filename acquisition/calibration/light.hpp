#pragma once

#include <opencv2/core/mat.hpp>

#include "firmware_bridge/wire/transfer.hpp"

namespace biotomy::acquisition {

/// The values of a picture, CV_8UC3 or CV_16UC3, in proportion to the light: CV_16UC3, 65535 is
/// full scale.
cv::Mat light_of(const cv::Mat& image, bridge::Transfer transfer);

}  // namespace biotomy::acquisition
