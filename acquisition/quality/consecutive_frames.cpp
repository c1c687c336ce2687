#include "acquisition/quality/consecutive_frames.hpp"

#include <utility>

#include "acquisition/quality/accepted_layer.hpp"

namespace biotomy::acquisition {

void ConsecutiveFrames::recall(FaceRecord faces, SharpnessRecord sharpness,
                               SurfaceRecord surfaces) {
  expectation_.faces = std::move(faces);
  expectation_.sharpness = std::move(sharpness);
  expectation_.surfaces = std::move(surfaces);
}

Assessment ConsecutiveFrames::judge(const cv::Mat& image, std::int64_t layer,
                                    const std::optional<CameraNoise>& noise) {
  if (expectation_.width == 0) {
    expectation_.width = image.cols;
    expectation_.height = image.rows;
    expectation_.type = image.type();
  }
  expectation_.layer = layer;
  if (noise && !expectation_.sharpness.noise()) expectation_.sharpness.know_noise(*noise);
  bridge::Frame frame;
  frame.image = image;
  Assessment assessment = assess(frame, expectation_, thresholds_);
  assessment.noise = noise;
  if (assessment.face) expectation_.faces.saw(*assessment.face);
  return assessment;
}

void ConsecutiveFrames::accept(const Assessment& assessment, bool flagged) {
  if (!assessment.face) return;
  accept_layer(expectation_.layer, assessment, flagged, expectation_);
}

}  // namespace biotomy::acquisition
