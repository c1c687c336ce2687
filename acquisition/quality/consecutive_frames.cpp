#include "acquisition/quality/consecutive_frames.hpp"

namespace biotomy::acquisition {

Assessment ConsecutiveFrames::judge(const cv::Mat& image, std::int64_t layer) {
  if (expectation_.width == 0) {
    expectation_.width = image.cols;
    expectation_.height = image.rows;
    expectation_.type = image.type();
  }
  expectation_.layer = layer;
  bridge::Frame frame;
  frame.image = image;
  Assessment assessment = assess(frame, expectation_, thresholds_);
  if (assessment.face) expectation_.faces.saw(*assessment.face);
  return assessment;
}

void ConsecutiveFrames::accept(const Assessment& assessment) {
  if (!assessment.face) return;
  expectation_.faces.accept(expectation_.layer, assessment.face, assessment.face_change);
  expectation_.sharpness.accept(assessment.measures);
  expectation_.surfaces.accept(expectation_.layer, assessment.surface, assessment.light,
                               assessment.arrived);
}

}  // namespace biotomy::acquisition
