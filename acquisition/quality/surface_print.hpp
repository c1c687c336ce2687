#pragma once

#include <memory>

#include <opencv2/core/mat.hpp>

#include "acquisition/quality/shift.hpp"
#include "acquisition/quality/surface_colours.hpp"

namespace biotomy::acquisition {

/// What is kept of a photograph of a face to tell later what changed in the light, in the face's
/// colours and in the place of the block. At 20 megapixels some 6 MB.
struct SurfacePrint {
  cv::Mat thumbnail;                              ///< see take_thumbnail; empty in a tiny frame
  cv::Mat light;                                  ///< see light_grid
  std::shared_ptr<const SurfaceColours> colours;  ///< of the thumbnail
  BorderPatches border;
};

/// `image` is CV_8UC3 or CV_16UC3, R G B.
SurfacePrint take_surface_print(const cv::Mat& image);

}  // namespace biotomy::acquisition
