#include "acquisition/focus/depth_of_field.hpp"

namespace biotomy::acquisition {

bridge::Micrometres depth_of_field(const Optics& optics) {
  const double aperture = optics.numerical_aperture;
  return (1.0 / (aperture * aperture)) * optics.wavelength + (1.0 / aperture) * optics.pixel;
}

bridge::Micrometres depth_of_field_by_curve(bridge::Micrometres suitable_step, int points) {
  return (0.5 * (points - 1)) * suitable_step;
}

}  // namespace biotomy::acquisition
