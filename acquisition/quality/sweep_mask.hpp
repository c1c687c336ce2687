#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace biotomy::acquisition {

/// Where the frames of a focus sweep can be compared: pixels that are clipped in no frame.
///
/// A spot that is clipped has a steep rim, which grows as the spot gets blurred: its gradients rise
/// where all others fall. What a spot covers in any frame, and a margin, is therefore left out of
/// all of them. When that leaves nothing, frames that are clipped over more than half of their area
/// have no say in what the others may show.
class SweepMask {
 public:
  explicit SweepMask(cv::Size frame);

  /// Takes in one frame, CV_8UC3 or CV_16UC3 of the size given, R G B. The part of its pixels in
  /// which a colour is clipped.
  double add(const cv::Mat& image);

  /// After the last frame: where the frames can be compared, CV_8UC1 of 0 and 1 at half the
  /// resolution. The margin is as wide as leaves at least a twentieth; without one, a 200th; empty
  /// when there is less.
  cv::Mat usable() const;

 private:
  cv::Mat clipped_;           ///< CV_8UC1 at half the resolution: clipped in some frame
  cv::Mat clipped_in_fewer_;  ///< likewise, in some frame that is not clipped over more than half
  int fewer_ = 0;             ///< frames of that kind
};

}  // namespace biotomy::acquisition
