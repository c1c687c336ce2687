#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace biotomy::tests {

/// A focus sweep of one field with all that makes sweeps hard to rank.
struct MadeUpSweep {
  enum class Field {
    textured,     ///< detail of all sizes everywhere
    a_few_marks,  ///< a few small marks on an even ground
    even,         ///< nothing to see
  };

  Field field = Field::textured;
  cv::Size size{512, 384};
  int type = CV_8UC3;
  bool grey = false;
  double brightness = 0.4;              ///< mean of the field, of full scale
  double contrast = 0.15;               ///< standard deviation of the texture, of full scale
  double noise = 0.004;                 ///< standard deviation at a pixel, of full scale
  std::vector<double> blur_px;          ///< radius of each frame's disc of confusion
  std::vector<double> exposure = {};    ///< of each frame, relative; all 1 if empty
  std::vector<double> noise_gain = {};  ///< of each frame's noise; all 1 if empty
  double breathing = 0.0;               ///< part by which the magnification grows a frame
  int bright_spots = 0;                 ///< many times brighter than full scale
  double spot_brightness = 20.0;        ///< of full scale
  double spot_radius_px = 4.0;
  double deep_part = 0.0;  ///< part of the width, from the right, that lies deeper:
  int deep_frames = 0;     ///< its blur is that of so many frames earlier
  std::uint64_t seed = 1;

  std::size_t frames() const { return blur_px.size(); }

  /// A frame, R G B. The same one whenever it is asked for.
  cv::Mat frame(std::size_t number) const;
};

}  // namespace biotomy::tests
