#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace biotomy::sim {

struct SensorSettings {
  int bits = 8;                        ///< a channel: 8 or 16
  bool mosaic = false;                 ///< one colour a pixel: see interpolate_mosaic
  double nominal_exposure_us = 10000;  ///< at gain 1 and with the lamp on, shows true levels
  double photons_at_white = 16000;     ///< collected for level 255 at gain 1
  double read_noise_levels = 0.5;      ///< standard deviation at gain 1
  double vignetting = 0.08;            ///< share of the light lost in the corners
  double stray_light = 0.002;          ///< of the lamp's light, when it is off
};

struct ExposureSettings {
  double exposure_us = 10000;
  double gain = 1.0;
  double red_gain = 1.0;
  double blue_gain = 1.0;
};

/// Turns the light that reaches it into a photograph. Linear in light; every pixel carries photon
/// noise, whose variance grows with the light, and read noise. The same seed and frame number give
/// the same noise.
class Sensor {
 public:
  /// At most kMostColumns wide.
  static constexpr int kMostColumns = 1 << 16;
  Sensor(std::uint64_t seed, int width, int height, const SensorSettings& settings);

  /// `light` is CV_32FC3 in levels at the nominal exposure, of the sensor's size, of which the
  /// lamp gives the share `lamp`; the answer is CV_8UC3 or CV_16UC3, R, G, B; what is too bright is
  /// clipped.
  cv::Mat expose(const cv::Mat& light, double lamp, const ExposureSettings& exposure,
                 std::uint64_t frame) const;

 private:
  std::uint64_t seed_;
  SensorSettings settings_;
  std::vector<float> across_;  ///< the light lost for each column, and for each row
  std::vector<float> down_;
  std::vector<float> noise_;  ///< standard normal
};

}  // namespace biotomy::sim
