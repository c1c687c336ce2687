#include "tests/acquisition/quality/phantom_photographer.hpp"

#include <span>

#include <opencv2/core.hpp>

#include "sim/physics/defocus.hpp"

namespace biotomy::tests {

PhantomPhotographer::PhantomPhotographer(const PhotographerSettings& settings)
    : settings_(settings),
      phantom_({.seed = settings.seed}),
      sensor_(settings.seed, settings.width, settings.height, settings.sensor) {}

cv::Mat PhantomPhotographer::photograph(double depth_um, double shift_x, double shift_y,
                                        double defocus_um) {
  cv::Mat light(settings_.height, settings_.width, CV_32FC3);
  const double pixel = settings_.pixel_um;
  for (int y = 0; y < light.rows; ++y) {
    const std::span row(reinterpret_cast<sim::Colour*>(light.ptr<float>(y)),
                        static_cast<std::size_t>(light.cols));
    phantom_.paint_row(settings_.left_um + shift_x * pixel, pixel,
                       settings_.top_um + (y + shift_y) * pixel, depth_um, row);
  }
  const sim::Lens lens{.numerical_aperture = settings_.numerical_aperture};
  sim::blur(light, sim::blur_sigma_um(lens, defocus_um) / pixel);
  return sensor_.expose(light, true, {}, ++photographs_);
}

}  // namespace biotomy::tests
