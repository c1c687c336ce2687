#pragma once

#include "firmware_bridge/micrometres.hpp"

namespace biotomy::acquisition {

struct Optics {
  double numerical_aperture = 0.0;  ///< on the face's side, in air
  bridge::Micrometres wavelength{0.55};
  bridge::Micrometres pixel{10.0};  ///< on the face
};

/// From the nearest to the farthest plane that is sharp at once: λ/NA² by diffraction and e/NA by
/// the pixel e, beyond which blur would be seen. S. Inoué & K. R. Spring, Video Microscopy, 2nd
/// ed., Plenum 1997, 2.4.5, with a refractive index of 1.
bridge::Micrometres depth_of_field(const Optics& optics);

/// The same by a curve of detail, from the step of the bracket of so many points that suits it (see
/// Autofocus::Found): as far as the bracket's ends lie from the peak. A plane half of it away from
/// the peak keeps 93 % of the detail's energy.
bridge::Micrometres depth_of_field_by_curve(bridge::Micrometres suitable_step, int points);

}  // namespace biotomy::acquisition
