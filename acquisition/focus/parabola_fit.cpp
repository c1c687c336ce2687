#include "acquisition/focus/parabola_fit.hpp"

#include <cmath>
#include <limits>

#include <opencv2/core.hpp>

namespace biotomy::acquisition {

std::optional<ParabolaFit> fit_parabola(std::span<const MeasuredPoint> points) {
  constexpr std::size_t kLeastPoints = 4;
  if (points.size() < kLeastPoints) return std::nullopt;
  cv::Matx33d normal = cv::Matx33d::zeros();
  cv::Vec3d right;
  double weights = 0.0;
  for (const MeasuredPoint& point : points) {
    const cv::Vec3d powers(1.0, point.x, point.x * point.x);
    normal += point.weight * (powers * powers.t());
    right += point.weight * point.y * powers;
    weights += point.weight;
  }
  bool determined = false;
  const cv::Matx33d inverse = normal.inv(cv::DECOMP_CHOLESKY, &determined);
  if (!determined) return std::nullopt;
  const cv::Vec3d parts = inverse * right;
  const double slope = parts[1];
  const double square = parts[2];
  if (square >= -std::numeric_limits<double>::epsilon()) return std::nullopt;

  ParabolaFit fit;
  fit.vertex = -0.5 * slope / square;
  fit.top = parts[0] - 0.25 * slope * slope / square;
  fit.curvature = -2.0 * square;
  double variance = 0.0;
  double squares = 0.0;
  for (const MeasuredPoint& point : points) {
    const cv::Vec3d powers(1.0, point.x, point.x * point.x);
    const cv::Vec3d by_point = point.weight * (inverse * powers);  // of the parts, by y
    const double vertex_by_point = 0.5 * (slope * by_point[2] / square - by_point[1]) / square;
    variance += std::pow(vertex_by_point * point.error, 2);
    squares += point.weight * std::pow(point.y - parts.dot(powers), 2);
  }
  fit.vertex_error = std::sqrt(variance);
  fit.residual = std::sqrt(squares / weights);
  return fit;
}

}  // namespace biotomy::acquisition
