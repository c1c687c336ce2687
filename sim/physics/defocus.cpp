#include "sim/physics/defocus.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <opencv2/imgproc.hpp>

namespace biotomy::sim {

namespace {

constexpr double kLeastSigma = 0.05;

/// Above it the picture is blurred on a coarser grid, where the same blur costs less.
constexpr double kWideSigma = 4.0;

void blur_directly(cv::Mat& picture, double sigma) {
  const std::vector<double> weights = blur_weights(sigma);
  cv::sepFilter2D(picture, picture, -1, weights, weights, {-1, -1}, 0.0, cv::BORDER_REPLICATE);
}

}  // namespace

double blur_sigma_um(const Lens& lens, double defocus_um) {
  const double confusion = 2.0 * lens.numerical_aperture * std::fabs(defocus_um);
  const double diffraction = 0.225 * lens.wavelength_um / lens.numerical_aperture;
  return std::hypot(confusion / 4.0, diffraction);
}

std::vector<double> blur_weights(double sigma) {
  const double variance = sigma * sigma;
  const int radius = 1 + static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<double> weights(2 * static_cast<std::size_t>(radius) + 1);
  double sum = 0.0;
  for (int i = -radius; i <= radius; ++i) {
    double& weight = weights[static_cast<std::size_t>(i + radius)];
    weight = std::exp(-variance) * std::cyl_bessel_i(static_cast<double>(std::abs(i)), variance);
    sum += weight;
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

void blur(cv::Mat& picture, double sigma) {
  if (sigma < kLeastSigma) {
    return;
  }
  if (sigma <= kWideSigma) {
    blur_directly(picture, sigma);
    return;
  }
  const int least_side = std::min(picture.cols, picture.rows);
  const int factor = std::clamp(static_cast<int>(sigma / 2.0), 2, std::max(2, least_side / 8));
  cv::Mat coarse;
  cv::resize(picture, coarse,
             {std::max(1, picture.cols / factor), std::max(1, picture.rows / factor)}, 0, 0,
             cv::INTER_AREA);
  // Averaging over a cell (variance f²/12) and interpolating between cells (f²/6) blur already.
  const double left = std::sqrt(std::max(0.25, sigma * sigma / (factor * factor) - 0.25));
  blur_directly(coarse, std::min(left, 0.25 * std::min(coarse.cols, coarse.rows)));
  cv::resize(coarse, picture, picture.size(), 0, 0, cv::INTER_LINEAR);
}

std::vector<double> smear_weights(double pixels) {
  const double length = std::max(1.0, std::fabs(pixels));
  const int radius = static_cast<int>(std::ceil(0.5 * (length - 1.0)));
  std::vector<double> weights(2 * static_cast<std::size_t>(radius) + 1, 1.0 / length);
  if (radius > 0) {
    // The outermost pixels are passed over in part.
    weights.front() = weights.back() = 0.5 * (length - (2.0 * radius - 1.0)) / length;
  }
  return weights;
}

void smear_along_rows(cv::Mat& picture, double pixels) {
  const double length = std::min(std::fabs(pixels), static_cast<double>(picture.cols));
  if (length > 1.0) {
    cv::sepFilter2D(picture, picture, -1, smear_weights(length), std::vector<double>{1.0}, {-1, -1},
                    0.0, cv::BORDER_REPLICATE);
  }
}

double contrast_at_half_nyquist(const std::vector<double>& weights) {
  const double middle = 0.5 * static_cast<double>(weights.size() - 1);
  double response = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    response += weights[i] * std::cos(0.5 * std::numbers::pi * (static_cast<double>(i) - middle));
  }
  return std::fabs(response);
}

}  // namespace biotomy::sim
