#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "acquisition/quality/clipping_levels.hpp"

namespace biotomy::acquisition {

/// The brightness (R + 2 G + B)/4 of a part of a picture, of full scale, row by row in one block of
/// memory that is kept from part to part. A pixel that does not count is no number, and so is all
/// that is made of it.
struct BrightnessPlane {
  static constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

  int width = 0;
  int height = 0;
  std::vector<float> values;

  void resize(int columns, int rows) {
    width = columns;
    height = rows;
    values.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  }
  float* row(int y) {
    return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
  const float* row(int y) const {
    return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
};

/// Fills `plane` with a part of `image`, CV_8UC3 or CV_16UC3, R G B. A pixel in which a colour is
/// clipped counts for nothing.
void take_brightness(const cv::Mat& image, const cv::Rect& part, const ClippingLevels& levels,
                     BrightnessPlane& plane);

/// Fills `to` with the means of 2 × 2 pixels.
void halve(const BrightnessPlane& from, BrightnessPlane& to);

}  // namespace biotomy::acquisition
