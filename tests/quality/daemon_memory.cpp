#include "tests/quality/daemon_memory.hpp"

#include <memory>

#include "acquisition/quality/accepted_layer.hpp"
#include "acquisition/quality/frame_measures.hpp"

namespace biotomy::tests {

void DaemonMemory::begin(int layer, const bridge::Frame& frame) {
  expectation_.width = frame.image.cols;
  expectation_.height = frame.image.rows;
  expectation_.type = frame.image.type();
  expectation_.layer = layer;
}

void DaemonMemory::focused(const bridge::Frame& peak) {
  using acquisition::FrameMeasures;
  expectation_.sharpness.found_focus(
      expectation_.layer,
      std::make_shared<const FrameMeasures>(acquisition::measure_frame(peak.image)));
}

void DaemonMemory::accepted(const bridge::Frame& frame, const acquisition::Assessment& assessment) {
  expectation_.previous_sequence = frame.sequence;
  expectation_.previous_timestamp = frame.sensor_timestamp;
  if (!assessment.face) return;
  expectation_.faces.saw(*assessment.face);
  acquisition::accept_layer(expectation_.layer, assessment, false, expectation_);
}

}  // namespace biotomy::tests
