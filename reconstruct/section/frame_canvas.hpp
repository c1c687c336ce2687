#pragma once

#include <string>

#include <opencv2/core/mat.hpp>

#include "reconstruct/section/sampler.hpp"

namespace biotomy::reconstruct {

/// What the frames of a series are drawn on: as wide and as high as the largest picture, a strip
/// for the label below it, so that the label covers none of the picture. Sides are even, as films
/// want them.
class FrameCanvas {
 public:
  /// `longest_label` is ASCII and has to fit.
  FrameCanvas(cv::Size largest_picture, const std::string& longest_label, const Colour& background);

  cv::Size size() const { return size_; }

  /// `picture` (CV_8UC3 or CV_16UC3, R G B, no larger than the largest) centred on the background,
  /// the label in the strip.
  cv::Mat draw(const cv::Mat& picture, const std::string& label) const;

  /// The background with its label alone; `type` is CV_8UC3 or CV_16UC3.
  cv::Mat draw_empty(int type, const std::string& label) const;

 private:
  double text_scale_;
  int strip_height_;
  int baseline_;
  cv::Size size_;
  Colour background_;
};

}  // namespace biotomy::reconstruct
