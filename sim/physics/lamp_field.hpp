#pragma once

#include <array>

#include <opencv2/core/mat.hpp>

namespace biotomy::sim {

/// How the lamp's light over the face differs from even and white: not at all by default. How much
/// light it gives in all is another matter.
struct LampField {
  double slope_x = 0;  ///< by how much more of the mean light falls on the right edge than the left
  double slope_y = 0;  ///< likewise on the lower edge than the upper
  std::array<double, 3> colour{1, 1, 1};  ///< R, G, B: factors

  bool is_even() const;
  friend bool operator==(const LampField&, const LampField&) = default;
};

/// Lights a CV_32FC3 picture, R, G, B, by such a lamp, in place.
void light_up(cv::Mat& picture, const LampField& field);

}  // namespace biotomy::sim
