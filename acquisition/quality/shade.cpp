#include "acquisition/quality/shade.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace biotomy::acquisition {
namespace {

constexpr float kShade = 0.08F;    ///< of the logarithm
constexpr float kUniform = 0.3F;   ///< the colours' logarithms differ at most by this part
constexpr float kUnsure = 0.03F;   ///< and by so much anyway
constexpr float kLeast = 0.004F;   ///< of full scale: darker is black
constexpr float kTooDark = 0.02F;  ///< of full scale: nothing could be told to be darker
constexpr int kMedian = 5;

/// The logarithm of the part by which all colours of a cell changed; 0 where they differ in it.
float common_change(const cv::Vec3f& now, const cv::Vec3f& before) {
  if (std::min({before[0], before[1], before[2]}) < kTooDark) return 0.0F;
  cv::Vec3f changes;
  for (int c = 0; c < 3; ++c) changes[c] = std::log(std::max(now[c], kLeast) / before[c]);
  const auto [least, most] = std::minmax({changes[0], changes[1], changes[2]});
  const float middle = (changes[0] + changes[1] + changes[2]) / 3.0F;
  return most - least <= std::max(kUnsure, kUniform * std::fabs(middle)) ? middle : 0.0F;
}

}  // namespace

cv::Mat shaded(const cv::Mat& now, const cv::Mat& before) {
  cv::Mat change(now.size(), CV_32FC1);
  for (int y = 0; y < now.rows; ++y) {
    const auto* a = now.ptr<cv::Vec3f>(y);
    const auto* b = before.ptr<cv::Vec3f>(y);
    for (int x = 0; x < now.cols; ++x) change.at<float>(y, x) = common_change(a[x], b[x]);
  }
  cv::Mat usual;
  cv::medianBlur(change, usual, kMedian);
  return cv::abs(usual) > kShade;
}

}  // namespace biotomy::acquisition
