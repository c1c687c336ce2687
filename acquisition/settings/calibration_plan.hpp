#pragma once

#include <filesystem>

namespace biotomy::acquisition {

/// Which calibrations frames are corrected by, and where they lie.
struct CalibrationPlan {
  std::filesystem::path folder = "calibration";
  bool flat = false;
  bool dark = false;
  int frames = 16;  ///< whose mean is recorded
};

}  // namespace biotomy::acquisition
