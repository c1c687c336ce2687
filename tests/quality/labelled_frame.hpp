#pragma once

#include "firmware_bridge/camera/frame.hpp"
#include "tests/quality/defect.hpp"

namespace biotomy::tests {

/// What an assessment should make of a frame.
enum class Demand {
  accept,
  reject,
  either,  ///< the grey zone
};

/// A photograph of which is known what is wrong with it.
struct LabelledFrame {
  bridge::Frame frame{};
  Defect defect = Defect::none;
  double strength = 0.0;  ///< of the defect, in its kind's unit
  double contrast =
      1.0;  ///< at half the Nyquist frequency, of the best focus'; along the worse axis
  Demand demand = Demand::accept;
};

}  // namespace biotomy::tests
