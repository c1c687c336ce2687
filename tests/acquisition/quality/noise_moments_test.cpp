#include "acquisition/quality/noise_moments.hpp"

#include <array>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "acquisition/quality/face_print.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

/// The derivatives of a print of drawn noise, as a face is compared by them.
std::array<cv::Mat, kDerivatives> derivatives_of_noise() {
  cv::Mat noise(600, 600, CV_32FC1);
  cv::RNG(5).fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
  const cv::Mat band = print_band(noise, {20, 20, 560, 560});
  const cv::Rect inner(1, 1, band.cols - 2, band.rows - 2);
  const auto at = [&](int x, int y) { return band(inner + cv::Point(x, y)); };
  return {at(0, 0).clone(),
          0.5 * (at(1, 0) - at(-1, 0)),
          0.5 * (at(0, 1) - at(0, -1)),
          at(1, 0) + at(-1, 0) - 2.0 * at(0, 0),
          at(0, 1) + at(0, -1) - 2.0 * at(0, 0),
          0.25 * (at(1, 1) + at(-1, -1) - at(-1, 1) - at(1, -1))};
}

TEST(UnitNoiseMoments, AreThoseOfDrawnNoise) {
  const auto fields = derivatives_of_noise();
  const double whole = fields[0].dot(fields[0]);
  for (std::size_t i = 0; i < kDerivatives; ++i) {
    for (std::size_t j = 0; j < kDerivatives; ++j) {
      EXPECT_NEAR(fields[i].dot(fields[j]) / whole, unit_noise_moments()[i][j], 0.02)
          << i << ", " << j;
    }
  }
}

}  // namespace
}  // namespace biotomy::tests
