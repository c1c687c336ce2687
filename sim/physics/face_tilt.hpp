#pragma once

#include <opencv2/core/mat.hpp>

#include "sim/physics/defocus.hpp"

namespace biotomy::sim {

/// How far the face leans out of the focal plane: so much deeper at the right edge of the frame
/// than at the left, and at the lower edge than at the upper.
struct FaceTilt {
  double across_um = 0;
  double down_um = 0;

  friend bool operator==(const FaceTilt&, const FaceTilt&) = default;
};

/// Blurs a CV_32FC3 picture in place as a lens does whose focal plane is missed by `defocus_um` in
/// the middle and by more or less where the face leans. Within a cell of a sixteenth of the frame
/// the blur is the same.
void blur_tilted(cv::Mat& picture, const Lens& lens, double pixel_um, double defocus_um,
                 const FaceTilt& tilt);

}  // namespace biotomy::sim
