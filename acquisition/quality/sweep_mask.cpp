#include "acquisition/quality/sweep_mask.hpp"

#include <algorithm>
#include <cstdint>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "acquisition/quality/clipping_levels.hpp"

namespace biotomy::acquisition {
namespace {

constexpr double kOverexposed = 0.5;  ///< part of a frame's pixels
constexpr double kLeastUsable = 0.05;
constexpr double kVeryLeastUsable = 0.005;
constexpr int kWidestMargin = 100;  ///< this part of the width

template <typename Sample>
std::int64_t mark_clipped(const Sample* pixels, int width, const ClippingLevels& levels,
                          std::uint8_t* marks) {
  std::int64_t clipped = 0;
  for (int x = 0; x < width; ++x, pixels += 3) {
    if (!is_clipped(pixels, levels)) continue;
    marks[x / 2] = 1;
    ++clipped;
  }
  return clipped;
}

/// What is not clipped, nor within a margin of it.
cv::Mat usable_beside(const cv::Mat& clipped, double least) {
  const int widest = clipped.cols / kWidestMargin;
  for (int margin = widest;; margin /= 2) {
    cv::Mat wide;
    const cv::Size square(2 * margin + 1, 2 * margin + 1);
    cv::dilate(clipped, wide, cv::getStructuringElement(cv::MORPH_RECT, square));
    cv::Mat usable = 1 - wide;
    if (cv::countNonZero(usable) > least * static_cast<double>(usable.total())) {
      return usable;
    }
    if (margin == 0) return {};
  }
}

}  // namespace

SweepMask::SweepMask(cv::Size frame)
    : clipped_(cv::Mat::zeros((frame.height + 1) / 2, (frame.width + 1) / 2, CV_8UC1)),
      clipped_in_fewer_(clipped_.clone()) {}

double SweepMask::add(const cv::Mat& image) {
  const ClippingLevels levels = clipping_levels(image);
  cv::Mat found = cv::Mat::zeros(clipped_.size(), CV_8UC1);
  std::int64_t clipped = 0;
  for (int y = 0; y < image.rows; ++y) {
    auto* marks = found.ptr<std::uint8_t>(y / 2);
    clipped += image.depth() == CV_16U
                   ? mark_clipped(image.ptr<std::uint16_t>(y), image.cols, levels, marks)
                   : mark_clipped(image.ptr<std::uint8_t>(y), image.cols, levels, marks);
  }
  const double part = static_cast<double>(clipped) / static_cast<double>(image.total());
  clipped_ |= found;
  if (part <= kOverexposed) {
    clipped_in_fewer_ |= found;
    ++fewer_;
  }
  return part;
}

cv::Mat SweepMask::usable() const {
  cv::Mat usable = usable_beside(clipped_, kLeastUsable);
  if (usable.empty() && fewer_ > 1) usable = usable_beside(clipped_in_fewer_, kLeastUsable);
  return usable.empty() ? usable_beside(clipped_, kVeryLeastUsable) : usable;
}

}  // namespace biotomy::acquisition
