#pragma once

#include <opencv2/core/mat.hpp>

#include "firmware_bridge/wire/transfer.hpp"

namespace biotomy::acquisition {

/// The mean of the light in frames of one size and kind: what is the same in all of them stays,
/// noise goes.
class MeanFrame {
 public:
  /// `transfer` is how the frames' values follow the light.
  explicit MeanFrame(bridge::Transfer transfer) : transfer_(transfer) {}

  /// CV_8UC3 or CV_16UC3, R G B; at most 32000 of them. Throws CalibrationError when it is of
  /// another size or kind than those before.
  void add(const cv::Mat& image);

  int count() const { return count_; }
  int bits() const { return CV_MAT_DEPTH(type_) == CV_16U ? 16 : 8; }

  /// CV_16UC3, in proportion to the light; 65535 is full scale. There is a frame.
  cv::Mat mean() const;

  /// The largest part of its values that was clipped in a frame.
  double clipped() const { return clipped_; }

 private:
  bridge::Transfer transfer_;
  int type_ = 0;
  int count_ = 0;
  double clipped_ = 0.0;
  cv::Mat sum_;  ///< CV_32SC3
};

}  // namespace biotomy::acquisition
