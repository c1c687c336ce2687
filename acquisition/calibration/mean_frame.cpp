#include "acquisition/calibration/mean_frame.hpp"

#include <algorithm>

#include <opencv2/core.hpp>

#include "acquisition/calibration/calibration_record.hpp"
#include "acquisition/calibration/light.hpp"

namespace biotomy::acquisition {

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
  const double full = type_ == CV_16UC3 ? 65535.0 : 255.0;
  const int clipped = cv::countNonZero(image.reshape(1) == full);
  clipped_ = std::max(clipped_, clipped / (3.0 * static_cast<double>(image.total())));
  ++count_;
}

cv::Mat MeanFrame::mean() const {
  cv::Mat mean;
  sum_.convertTo(mean, CV_16U, 1.0 / count_);
  return mean;
}

}  // namespace biotomy::acquisition
