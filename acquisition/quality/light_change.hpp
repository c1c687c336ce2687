#pragma once

#include <array>

#include <opencv2/core/mat.hpp>

namespace biotomy::acquisition {

/// A smooth function over the frame: of u and v, which run from −1 at the left and upper edge to 1
/// at the others, the mixture of 1, u, v, u² − 1/3, u·v, v² − 1/3. The first coefficient is its
/// mean over the frame.
struct SmoothSurface {
  static constexpr std::size_t kTerms = 6;
  std::array<double, kTerms> coefficients{};

  static std::array<double, kTerms> terms(double u, double v);
  double at(double u, double v) const;
  double mean() const { return coefficients[0]; }
  double range() const;  ///< the greatest of it over the frame less the least
};

/// How the light of one frame differs from another's, colour by colour: the natural logarithm of
/// the ratio, over the frame.
struct LightChange {
  std::array<SmoothSurface, 3> colours;  ///< R, G, B

  /// Of the brightness, (R + 2 G + B)/4 of the logarithms.
  SmoothSurface brightness() const;
  /// How far the colours' means are apart: a colour that alone becomes 5 % stronger makes 0.05.
  double cast() const;
};

LightChange operator+(const LightChange& a, const LightChange& b);
LightChange operator-(const LightChange& a, const LightChange& b);

/// A change of light, and how sure it is.
struct MeasuredLight {
  LightChange change;
  double level_error = 0.0;  ///< standard deviation of the mean brightness' logarithm
  double range_error = 0.0;  ///< likewise of the range over the frame
  cv::Mat steady;            ///< 255 where a cell follows the light alone, CV_8UC1
};

/// Measures what the light did between two faces that are not the same: `now` and `before` are
/// light grids (CV_32FC3, see light_grid) of two layers, `casting` says where the former shows
/// casting material (CV_8UC1; all 0 if it is not known).
///
/// Most of a face is, cell by cell, as the face before; where it is not, as at an edge that moves,
/// the ratio of the two is far from that of the rest. So smooth surfaces are fitted to the
/// logarithm of the ratio by iteratively reweighted least squares with Tukey's biweight (Holland
/// and Welsch, "Robust regression using iteratively reweighted least-squares", Communications in
/// Statistics A6 (1977) 813-827). Casting material, which does not change, counts four times as
/// much. The errors are those of the fit, doubled: neighbours err alike.
MeasuredLight measure_light(const cv::Mat& now, const cv::Mat& before, const cv::Mat& casting);

/// A thumbnail averaged to at most 64 cells a side: more says no more of the light.
cv::Mat light_grid(const cv::Mat& thumbnail);

}  // namespace biotomy::acquisition
