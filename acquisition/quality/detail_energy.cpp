#include "acquisition/quality/detail_energy.hpp"

namespace biotomy::acquisition {
namespace {

constexpr double kImmerkaerNoise = 36.0;  ///< the sum of the squared weights of (1 -2 1) × (1 -2 1)

/// Rows are summed in single, parts in double precision.
struct Mean {
  double sum = 0.0;
  double count = 0.0;

  void add(float row_sum, float row_count) {
    sum += static_cast<double>(row_sum);
    count += static_cast<double>(row_count);
  }
  double value() const { return count > 0.0 ? sum / count : 0.0; }
};

/// Sobel's gradients at a place of a row, along it and across the rows.
inline float gradient_along(const float* above, const float* here, const float* below, int i) {
  return 0.125F * ((above[i + 1] + 2.0F * here[i + 1] + below[i + 1]) -
                   (above[i - 1] + 2.0F * here[i - 1] + below[i - 1]));
}
inline float gradient_across(const float* above, const float* below, int i) {
  return 0.125F * ((below[i - 1] + 2.0F * below[i] + below[i + 1]) -
                   (above[i - 1] + 2.0F * above[i] + above[i + 1]));
}

/// All that is measured of the picture itself, with the noise still in it.
struct FullResolution {
  DetailEnergy curvature;
  DetailEnergy gradient;
  double noise_variance = 0.0;
};

/// Over an inner part of a plane. A pixel counts when all its neighbours are numbers.
FullResolution look_closely(const BrightnessPlane& plane, const cv::Rect& part) {
  Mean xx;
  Mean yy;
  Mean x;
  Mean y;
  Mean noise;
  for (int row = part.y; row < part.br().y; ++row) {
    const float* above = plane.row(row - 1);
    const float* here = plane.row(row);
    const float* below = plane.row(row + 1);
    float sum_xx = 0.0F;
    float sum_yy = 0.0F;
    float sum_x = 0.0F;
    float sum_y = 0.0F;
    float sum_noise = 0.0F;
    float count = 0.0F;
#pragma omp simd reduction(+ : sum_xx, sum_yy, sum_x, sum_y, sum_noise, count)
    for (int i = part.x; i < part.br().x; ++i) {
      const float beside = here[i - 1] + here[i + 1];
      const float over = above[i] + below[i];
      const float corners = above[i - 1] + above[i + 1] + below[i - 1] + below[i + 1];
      const float cxx = beside - 2.0F * here[i];
      const float cyy = over - 2.0F * here[i];
      const float gx = gradient_along(above, here, below, i);
      const float gy = gradient_across(above, below, i);
      const float checkered = corners - 2.0F * (beside + over) + 4.0F * here[i];
      const bool counts = checkered == checkered;
      sum_xx += counts ? cxx * cxx : 0.0F;
      sum_yy += counts ? cyy * cyy : 0.0F;
      sum_x += counts ? gx * gx : 0.0F;
      sum_y += counts ? gy * gy : 0.0F;
      sum_noise += counts ? checkered * checkered : 0.0F;
      count += counts ? 1.0F : 0.0F;
    }
    xx.add(sum_xx, count);
    yy.add(sum_yy, count);
    x.add(sum_x, count);
    y.add(sum_y, count);
    noise.add(sum_noise, count);
  }
  return {{xx.value(), yy.value()}, {x.value(), y.value()}, noise.value() / kImmerkaerNoise};
}

/// The energy of the gradient alone, as above.
DetailEnergy gradient_energy(const BrightnessPlane& plane, const cv::Rect& part) {
  Mean along_x;
  Mean along_y;
  for (int y = part.y; y < part.br().y; ++y) {
    const float* above = plane.row(y - 1);
    const float* here = plane.row(y);
    const float* below = plane.row(y + 1);
    float row_x = 0.0F;
    float row_y = 0.0F;
    float count = 0.0F;
#pragma omp simd reduction(+ : row_x, row_y, count)
    for (int x = part.x; x < part.br().x; ++x) {
      const float gx = gradient_along(above, here, below, x);
      const float gy = gradient_across(above, below, x);
      const float both = gx + gy;
      const bool counts = both == both;
      row_x += counts ? gx * gx : 0.0F;
      row_y += counts ? gy * gy : 0.0F;
      count += counts ? 1.0F : 0.0F;
    }
    along_x.add(row_x, count);
    along_y.add(row_y, count);
  }
  return {along_x.value(), along_y.value()};
}

/// The part in a plane of the picture at `scale`, less a pixel where the plane ends.
cv::Rect inner_part(const BrightnessPlane& plane, const cv::Rect& part, int scale) {
  const cv::Rect inside(part.x / scale, part.y / scale, part.width / scale, part.height / scale);
  return inside & cv::Rect(1, 1, plane.width - 2, plane.height - 2);
}

}  // namespace

MeasuredDetail DetailMeasurer::measure(const BrightnessPlane& plane, const cv::Rect& part) {
  halve(plane, middle_);
  halve(middle_, coarse_);
  const FullResolution close = look_closely(plane, inner_part(plane, part, 1));
  return {.energy = {{close.curvature, close.gradient,
                      gradient_energy(middle_, inner_part(middle_, part, 2)),
                      gradient_energy(coarse_, inner_part(coarse_, part, 4))}},
          .noise_variance = close.noise_variance};
}

}  // namespace biotomy::acquisition
