#pragma once

#include <span>
#include <vector>

#include <opencv2/core/types.hpp>

#include "reconstruct/section/pixel_grid.hpp"

namespace biotomy::reconstruct {

/// A picture that follows others.
struct PictureInSequence {
  PixelGrid grid;
  Vector3 reference;  ///< a point of its plane that is to be seen at rest
};

struct AlignedPicture {
  PixelGrid grid;   ///< in the same rectangle, but for less than a pixel at its first sides
  cv::Point first;  ///< where its pixel (0, 0) lies
};

struct AlignedPictures {
  std::vector<AlignedPicture> pictures;
  cv::Size size;  ///< that holds all of them
};

/// Lays pictures over each other by their centres, to the nearest whole pixel from the first one's,
/// and has their pixels begin within the rectangle where the reference comes to lie on the same
/// fraction of a pixel as in the first: where the references are the centres, they stay in place
/// exactly. The first picture's pixels remain as they are; so do, along that side, those of one
/// that is too narrow to hold a pixel elsewhere.
AlignedPictures align_pictures(std::span<const PictureInSequence> pictures);

}  // namespace biotomy::reconstruct
