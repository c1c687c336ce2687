#pragma once

#include <array>

#include "reconstruct/geometry/plane.hpp"
#include "reconstruct/section/pixel_grid.hpp"

namespace biotomy::reconstruct {

/// A place in a picture of a section. Whole u and v are the centres of pixels, u counting columns
/// from the left and v rows from the top.
struct PicturePosition {
  double u = 0.0;
  double v = 0.0;
  double distance = 0.0;  ///< from the plane, micrometres, positive where its normal points
};

/// Where the pixels of a picture lie in the sample, and back, as matrices over micrometres:
///  - pixel_to_sample · (u, v, 1) = (x, y, z); its columns are s·p, s·q and the place of pixel
///    (0, 0), where s is the pixel size.
///  - sample_to_pixel · (x, y, z, 1) = (u, v, distance); its rows are p/s, q/s and the plane's
///    normal, with what makes pixel (0, 0) and the plane zero.
struct PictureAffine {
  std::array<std::array<double, 3>, 3> pixel_to_sample{};
  std::array<std::array<double, 4>, 3> sample_to_pixel{};

  Vector3 sample_at(double u, double v) const;
  PicturePosition picture_at(const Vector3& position) const;
};

/// Of a picture in which the grid's pixel (0, 0) is the pixel (left, top): a frame of a series has
/// a border around its section. `plane` is the one that the grid lies in.
PictureAffine picture_affine(const PixelGrid& grid, const Plane& plane, int left = 0, int top = 0);

}  // namespace biotomy::reconstruct
