#include "sim/physics/defocus.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace biotomy::sim {

namespace {

constexpr double kLeastSigma = 0.05;

/// Above it the picture is blurred on a coarser grid, where the same blur costs less.
constexpr double kWideSigma = 4.0;

/// The discrete Gaussian exp(-t)·I_n(t), t = σ² (Lindeberg, "Scale-space for discrete signals",
/// IEEE PAMI 12 (1990) 234-254). Its variance is σ² however small that is; a Gaussian sampled at
/// whole pixels would blur a third as much as it should at σ = 0.36.
cv::Mat discrete_gaussian(double sigma) {
  const double variance = sigma * sigma;
  const int radius = std::max(1, static_cast<int>(std::ceil(3.0 * sigma))) + 1;
  cv::Mat kernel(2 * radius + 1, 1, CV_64F);
  for (int n = -radius; n <= radius; ++n) {
    kernel.at<double>(n + radius) =
        std::exp(-variance) * std::cyl_bessel_i(static_cast<double>(std::abs(n)), variance);
  }
  return kernel / cv::sum(kernel)[0];
}

void blur_directly(cv::Mat& picture, double sigma) {
  const cv::Mat kernel = discrete_gaussian(sigma);
  cv::sepFilter2D(picture, picture, -1, kernel, kernel, {-1, -1}, 0.0, cv::BORDER_REPLICATE);
}

}  // namespace

double blur_sigma_um(const Lens& lens, double defocus_um) {
  const double confusion = 2.0 * lens.numerical_aperture * std::fabs(defocus_um);
  const double diffraction = 0.225 * lens.wavelength_um / lens.numerical_aperture;
  return std::hypot(confusion / 4.0, diffraction);
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

void smear_along_rows(cv::Mat& picture, double pixels) {
  const int length = std::min(static_cast<int>(std::lround(std::fabs(pixels))), picture.cols);
  if (length > 1) {
    cv::blur(picture, picture, {length, 1}, {-1, -1}, cv::BORDER_REPLICATE);
  }
}

}  // namespace biotomy::sim
