#include "acquisition/focus/depth_of_field.hpp"

namespace biotomy::acquisition {

bridge::Micrometres depth_of_field(const Optics& optics) {
  const double aperture = optics.numerical_aperture;
  return (1.0 / (aperture * aperture)) * optics.wavelength + (1.0 / aperture) * optics.pixel;
}

}  // namespace biotomy::acquisition
