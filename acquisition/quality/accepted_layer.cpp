#include "acquisition/quality/accepted_layer.hpp"

namespace biotomy::acquisition {

void accept_layer(std::int64_t layer, const Assessment& assessment, bool flagged,
                  FrameExpectation& expectation) {
  expectation.faces.accept(layer, assessment.face, assessment.face_change);
  // Beside a layer that lacks sharpness the next one would pass for sharp.
  if (!flagged) {
    expectation.sharpness.accept(assessment.measures);
    if (assessment.noise) expectation.sharpness.know_noise(*assessment.noise);
  }
  expectation.surfaces.accept(layer, assessment.surface, assessment.light, assessment.arrived);
}

}  // namespace biotomy::acquisition
