#include "reconstruct/section/frame_canvas.hpp"

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kWidthForFullSize = 800.0;  // pixels; wider pictures get larger letters
constexpr double kLeastTextScale = 0.5;
constexpr int kMargin = 8;
constexpr double kLevels8To16 = 257.0;

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

}  // namespace

FrameCanvas::FrameCanvas(cv::Size largest_picture, const std::string& longest_label,
                         const Colour& background)
    : text_scale_(std::max(kLeastTextScale, largest_picture.width / kWidthForFullSize)),
      strip_height_(0),
      baseline_(0),
      background_(background) {
  const cv::Size text =
      cv::getTextSize(longest_label, kFont, text_scale_, stroke(text_scale_), &baseline_);
  strip_height_ = text.height + baseline_ + 2 * kMargin;
  size_ = {even(std::max(largest_picture.width, text.width + 2 * kMargin)),
           even(largest_picture.height + strip_height_)};
}

cv::Mat FrameCanvas::draw_empty(int type, const std::string& label) const {
  const Colour white{255, 255, 255};
  cv::Mat frame(size_, type, levels(background_, CV_MAT_DEPTH(type)));
  const cv::Point left_of_baseline(kMargin, size_.height - kMargin - baseline_);
  cv::putText(frame, label, left_of_baseline, kFont, text_scale_, levels(white, frame.depth()),
              stroke(text_scale_), cv::LINE_AA);
  return frame;
}

cv::Mat FrameCanvas::draw(const cv::Mat& picture, const std::string& label) const {
  const cv::Size room(size_.width, size_.height - strip_height_);
  if (picture.cols > room.width || picture.rows > room.height) {
    throw InvalidRequest("a frame is larger than the largest of its series");
  }
  cv::Mat frame = draw_empty(picture.type(), label);
  const cv::Rect centred((room.width - picture.cols) / 2, (room.height - picture.rows) / 2,
                         picture.cols, picture.rows);
  picture.copyTo(frame(centred));
  return frame;
}

}  // namespace biotomy::reconstruct
