#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

#include "sim/phantom/phantom.hpp"
#include "sim/physics/sensor.hpp"

namespace biotomy::tests {

/// How the twin's specimen is photographed for a test of quality.
struct PhotographerSettings {
  std::uint64_t seed = 1;
  int width = 320;
  int height = 320;
  double pixel_um = 10.0;
  double left_um = 3000.0;  ///< where the picture begins on a specimen of 10 mm: in the joint
  double top_um = 2500.0;
  double numerical_aperture = 0.1;
  sim::SensorSettings sensor{};
};

/// Takes pictures of the phantom as the twin does, without the rig around it. Every picture has
/// noise of its own.
class PhantomPhotographer {
 public:
  explicit PhantomPhotographer(const PhotographerSettings& settings);

  /// The face at a depth, displaced by pixels and out of focus.
  cv::Mat photograph(double depth_um, double shift_x = 0.0, double shift_y = 0.0,
                     double defocus_um = 0.0);

 private:
  PhotographerSettings settings_;
  sim::Phantom phantom_;
  sim::Sensor sensor_;
  std::uint64_t photographs_ = 0;
};

}  // namespace biotomy::tests
