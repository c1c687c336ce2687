#include "reconstruct/section/frame_canvas.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;  // has ASCII alone: "um" and not the Greek letter
constexpr double kWidthForFullSize = 800.0;      // pixels; larger pictures get larger letters
constexpr double kHeightForFullSize = 200.0;     // so that the strip stays lower than the picture
constexpr double kLeastTextScale = 0.5;
constexpr int kMargin = 8;
constexpr double kWholePixel = 1e-6;
constexpr double kLevels8To16 = 257.0;
constexpr Colour kWhite{255, 255, 255};
constexpr Colour kBlack{0, 0, 0};
constexpr double kLight = 128.0;  // the luma from which black is seen better than white

int even(int length) {
  return length + length % 2;
}

int stroke(double text_scale) {
  return std::max(1, static_cast<int>(text_scale));
}

cv::Scalar levels(const Colour& colour, int depth) {
  const double scale = depth == CV_16U ? kLevels8To16 : 1.0;
  return {scale * colour[0], scale * colour[1], scale * colour[2]};
}

/// What can be read on a background, by its luma (ITU-R BT.601, section 2.5.1).
Colour ink_on(const Colour& background) {
  const double luma = 0.299 * background[0] + 0.587 * background[1] + 0.114 * background[2];
  return luma < kLight ? kWhite : kBlack;
}

int text_width(const std::string& text, double text_scale) {
  int baseline = 0;
  return cv::getTextSize(text, kFont, text_scale, stroke(text_scale), &baseline).width;
}

/// That a bar covers, wholly or in part.
int touched_pixels(const ScaleBar& bar) {
  return std::max(1, static_cast<int>(std::ceil(bar.pixels - kWholePixel)));
}

}  // namespace

FrameCanvas::FrameCanvas(cv::Size largest_picture, const std::string& longest_label,
                         const Colour& background, std::optional<ScaleBar> bar)
    : text_scale_(std::max(kLeastTextScale, std::min(largest_picture.width / kWidthForFullSize,
                                                     largest_picture.height / kHeightForFullSize))),
      background_(background),
      ink_(ink_on(background)),
      bar_(std::move(bar)) {
  const cv::Size text =
      cv::getTextSize(longest_label, kFont, text_scale_, stroke(text_scale_), &below_baseline_);
  text_height_ = text.height;
  if (bar_ || !longest_label.empty()) {
    strip_height_ = text.height + below_baseline_ + 2 * kMargin;
  }
  size_ = {even(std::max(largest_picture.width, strip_width(text.width))),
           even(largest_picture.height + strip_height_)};
}

int FrameCanvas::strip_width(int label_width) const {
  const int label = label_width == 0 ? 0 : label_width + 2 * kMargin;
  return bar_ ? label + touched_pixels(*bar_) + text_width(bar_->label, text_scale_) + 3 * kMargin
              : label;
}

void FrameCanvas::draw_bar(cv::Mat& frame, int baseline) const {
  const cv::Scalar ink = levels(ink_, frame.depth());
  const int text_left = size_.width - kMargin - text_width(bar_->label, text_scale_);
  cv::putText(frame, bar_->label, {text_left, baseline}, kFont, text_scale_, ink,
              stroke(text_scale_), cv::LINE_AA);
  const int thickness = std::max(2, text_height_ / 4);
  const int touched = touched_pixels(*bar_);
  const int left = text_left - kMargin - touched;
  const int top = baseline - text_height_ / 2 - thickness / 2;
  frame(cv::Rect(left, top, touched, thickness)).setTo(ink);
  // The bar's beginning covers a part of its pixel: so it has its length to less than a pixel.
  const double covered = 1.0 - (touched - bar_->pixels);
  const cv::Scalar paper = levels(background_, frame.depth());
  frame(cv::Rect(left, top, 1, thickness)).setTo(covered * ink + (1.0 - covered) * paper);
}

cv::Mat FrameCanvas::draw_empty(int type, const std::string& label) const {
  cv::Mat frame(size_, type, levels(background_, CV_MAT_DEPTH(type)));
  const int baseline = size_.height - kMargin - below_baseline_;
  if (!label.empty()) {
    cv::putText(frame, label, {kMargin, baseline}, kFont, text_scale_, levels(ink_, frame.depth()),
                stroke(text_scale_), cv::LINE_AA);
  }
  if (bar_) {
    draw_bar(frame, baseline);
  }
  return frame;
}

double FrameCanvas::bytes(int type) const {
  return static_cast<double>(size_.width) * size_.height * static_cast<double>(CV_ELEM_SIZE(type));
}

cv::Size FrameCanvas::room() const {
  return {size_.width, size_.height - strip_height_};
}

cv::Point FrameCanvas::place_of(cv::Size picture) const {
  if (picture.width > room().width || picture.height > room().height) {
    throw InvalidRequest("a picture is larger than the canvas of its series");
  }
  return {(room().width - picture.width) / 2, (room().height - picture.height) / 2};
}

cv::Mat FrameCanvas::part_for(const cv::Rect& picture, cv::Mat& frame) const {
  if ((picture & cv::Rect({0, 0}, room())) != picture) {
    throw InvalidRequest("a picture does not lie on the canvas of its series");
  }
  return frame(picture);
}

}  // namespace biotomy::reconstruct
