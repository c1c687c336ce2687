#include "tests/faults/same_face.hpp"

#include <limits>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace biotomy::tests {

namespace {

cv::Mat smooth(const cv::Mat& image) {
  cv::Mat light;
  image.convertTo(light, CV_32F);
  cv::blur(light, light, {3, 3});
  return light;
}

}  // namespace

double face_difference(const cv::Mat& one, const cv::Mat& other) {
  if (one.size() != other.size() || one.type() != other.type()) {
    return std::numeric_limits<double>::infinity();
  }
  return cv::norm(smooth(one), smooth(other), cv::NORM_L1) /
         static_cast<double>(one.total() * static_cast<std::size_t>(one.channels()));
}

}  // namespace biotomy::tests
