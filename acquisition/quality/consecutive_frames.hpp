#pragma once

#include <cstdint>
#include <optional>

#include <opencv2/core/mat.hpp>

#include "acquisition/quality/assessment.hpp"

namespace biotomy::acquisition {

/// Judges images as the daemon judges the frames of consecutive layers, long after they were taken:
/// each is compared with those before it. What only the camera knew is not judged: when a frame was
/// exposed, and what a focus search found.
class ConsecutiveFrames {
 public:
  /// A layer's images are of the size and kind of the first.
  explicit ConsecutiveFrames(const QualityThresholds& thresholds) : thresholds_(thresholds) {}

  /// What the next image is compared with, in place of all images before.
  void recall(FaceRecord faces, SharpnessRecord sharpness, SurfaceRecord surfaces);

  /// The next image, CV_8UC3 or CV_16UC3, R G B. Findings name the layers by these numbers, which
  /// may leave some out. `noise` is what the layer's focus search told of it, if it did.
  Assessment judge(const cv::Mat& image, std::int64_t layer,
                   const std::optional<CameraNoise>& noise = std::nullopt);

  /// The image judged last is a layer: the next ones are compared with it; in their sharpness only
  /// when it has no flag.
  void accept(const Assessment& assessment, bool flagged);

 private:
  QualityThresholds thresholds_;
  FrameExpectation expectation_;
};

}  // namespace biotomy::acquisition
