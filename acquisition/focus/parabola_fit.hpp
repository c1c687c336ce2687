#pragma once

#include <optional>
#include <span>

namespace biotomy::acquisition {

/// A value that was measured at x, with its standard deviation by noise and its say in the fit.
struct MeasuredPoint {
  double x = 0.0;
  double y = 0.0;
  double error = 0.0;
  double weight = 1.0;
};

/// y = top − ½ · curvature · (x − vertex)², with curvature > 0.
struct ParabolaFit {
  double vertex = 0.0;
  double vertex_error = 0.0;  ///< standard deviation, by the points' own
  double top = 0.0;
  double curvature = 0.0;
  double residual = 0.0;  ///< weighted root mean square of what the parabola leaves of y
};

/// The parabola of least weighted squares through at least four points; nothing when it does not
/// have a peak, or the points do not determine one.
std::optional<ParabolaFit> fit_parabola(std::span<const MeasuredPoint> points);

}  // namespace biotomy::acquisition
