#pragma once

#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>

#include "reconstruct/section/sampler.hpp"
#include "reconstruct/section/scale_bar.hpp"

namespace biotomy::reconstruct {

/// What the frames of a series, and a section with a scale bar, are drawn on: as wide and as high
/// as the largest picture, a strip below it for the label on the left and the scale bar on the
/// right, so that they cover none of the picture; no strip where there is neither. Both are white,
/// on a light background black. Sides are even, as films want them.
class FrameCanvas {
 public:
  /// `longest_label` is ASCII and has to fit, empty when pictures have no label; so has the bar, if
  /// there is one.
  FrameCanvas(cv::Size largest_picture, const std::string& longest_label, const Colour& background,
              std::optional<ScaleBar> bar = std::nullopt);

  cv::Size size() const { return size_; }

  /// Of a frame of this type in memory.
  double bytes(int type) const;

  /// Where the first pixel of a picture of this size comes to lie. Throws InvalidRequest for a
  /// picture that is larger than the largest.
  cv::Point place_of(cv::Size picture) const;

  /// The background with its label and its scale bar alone; `type` is CV_8UC3 or CV_16UC3.
  cv::Mat draw_empty(int type, const std::string& label) const;

  /// The pixels of `frame`, a drawn one, that a picture fills: to be drawn there at once, so that a
  /// large picture is in memory once. Throws InvalidRequest where it does not lie in the room for
  /// pictures.
  cv::Mat part_for(const cv::Rect& picture, cv::Mat& frame) const;

 private:
  cv::Size room() const;
  int strip_width(int label_width) const;
  void draw_bar(cv::Mat& frame, int baseline) const;

  double text_scale_;
  int text_height_ = 0;
  int strip_height_ = 0;
  int below_baseline_ = 0;
  cv::Size size_;
  Colour background_;
  Colour ink_;
  std::optional<ScaleBar> bar_;
};

}  // namespace biotomy::reconstruct
