#include "acquisition/quality/noise_moments.hpp"

#include <vector>

#include <opencv2/core.hpp>

#include "acquisition/quality/face_print.hpp"

namespace biotomy::acquisition {
namespace {

struct Tap {
  int x = 0;
  int y = 0;
  double weight = 0.0;
};
using Stencil = std::vector<Tap>;

const std::array<Stencil, kDerivatives>& stencils() {
  static const std::array<Stencil, kDerivatives> all = {{
      {{0, 0, 1.0}},
      {{1, 0, 0.5}, {-1, 0, -0.5}},
      {{0, 1, 0.5}, {0, -1, -0.5}},
      {{1, 0, 1.0}, {-1, 0, 1.0}, {0, 0, -2.0}},
      {{0, 1, 1.0}, {0, -1, 1.0}, {0, 0, -2.0}},
      {{1, 1, 0.25}, {-1, -1, 0.25}, {-1, 1, -0.25}, {1, -1, -0.25}},
  }};
  return all;
}

/// What two taps so far apart have in common: the band of a single bright pixel, with itself.
double correlation(const cv::Mat& response, int dx, int dy) {
  constexpr int kFarthest = 2;
  const cv::Rect inner(kFarthest, kFarthest, response.cols - 2 * kFarthest,
                       response.rows - 2 * kFarthest);
  return response(inner).dot(response(inner + cv::Point(dx, dy)));
}

DerivativeMoments made_moments() {
  constexpr int kSide = 65;  // far more than the band's reach
  cv::Mat point = cv::Mat::zeros(kSide, kSide, CV_32F);
  point.at<float>(kSide / 2, kSide / 2) = 1.0F;
  const cv::Mat response = print_band(point, {0, 0, kSide, kSide});
  const double whole = correlation(response, 0, 0);
  DerivativeMoments moments{};
  for (std::size_t i = 0; i < kDerivatives; ++i) {
    for (std::size_t j = 0; j < kDerivatives; ++j) {
      for (const Tap& a : stencils()[i]) {
        for (const Tap& b : stencils()[j]) {
          moments[i][j] +=
              a.weight * b.weight * correlation(response, a.x - b.x, a.y - b.y) / whole;
        }
      }
    }
  }
  return moments;
}

}  // namespace

const DerivativeMoments& unit_noise_moments() {
  static const DerivativeMoments moments = made_moments();
  return moments;
}

}  // namespace biotomy::acquisition
