#include "acquisition/calibration/mean_frame.hpp"

#include <algorithm>
#include <cstddef>

#include <opencv2/core.hpp>

#include "acquisition/calibration/calibration_record.hpp"
#include "acquisition/calibration/light.hpp"
#include "acquisition/quality/clipping_levels.hpp"

namespace biotomy::acquisition {
namespace {

/// Of all colours' values.
double clipped_share(const cv::Mat& image) {
  const ClippingLevels levels = clipping_levels(image);
  double clipped = 0.0;
  for (int c = 0; c < 3; ++c) {
    cv::Mat colour;
    cv::extractChannel(image, colour, c);
    clipped += cv::countNonZero(colour >= levels.at(static_cast<std::size_t>(c)));
  }
  return clipped / (3.0 * static_cast<double>(image.total()));
}

}  // namespace

void MeanFrame::add(const cv::Mat& image) {
  if (image.type() != CV_8UC3 && image.type() != CV_16UC3) {
    throw CalibrationError("the camera gave no picture of 8 or 16 bits in three colours");
  }
  if (count_ == 0) {
    type_ = image.type();
    sum_ = cv::Mat::zeros(image.size(), CV_32SC3);
  }
  if (image.size() != sum_.size() || image.type() != type_) {
    throw CalibrationError("the camera changed the size or the bits of its frames meanwhile");
  }
  cv::add(sum_, light_of(image, transfer_), sum_, cv::noArray(), CV_32S);
  clipped_ = std::max(clipped_, clipped_share(image));
  ++count_;
}

cv::Mat MeanFrame::mean() const {
  cv::Mat mean;
  sum_.convertTo(mean, CV_16U, 1.0 / count_);
  return mean;
}

}  // namespace biotomy::acquisition
