#pragma once

#include "acquisition/quality/assessment.hpp"
#include "firmware_bridge/camera/frame.hpp"

namespace biotomy::tests {

/// What the daemon knows when it judges a frame: the layers that it accepted and the last focus
/// bracket, kept as a job's LayerCycle keeps it. Where assess() is given more to compare with, this
/// is the place to add it.
class DaemonMemory {
 public:
  /// The first frame of a layer is about to be judged.
  void begin(int layer, const bridge::Frame& frame);

  /// The sharpest frame of a focus bracket at this layer.
  void focused(const bridge::Frame& peak);

  /// The layer was accepted with this frame and judgement.
  void accepted(const bridge::Frame& frame, const acquisition::Assessment& assessment);

  /// What the next frame is compared with.
  const acquisition::FrameExpectation& expectation() const { return expectation_; }

 private:
  acquisition::FrameExpectation expectation_;
};

}  // namespace biotomy::tests
