#include "reconstruct/section/picture_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace biotomy::reconstruct {
namespace {

constexpr double kSamePlace = 1e-6;  // of a pixel

/// A side of a picture, in pixels of it.
struct Side {
  double length = 0.0;
  double reference = 0.0;  ///< from the side's beginning
};

/// How a side is aligned with the first picture's.
struct Shift {
  double part = 0.0;  ///< of a pixel, by which its pixels begin later
  int whole = 0;      ///< pixels, by which the first of them lies further on
};

Side side_along(const PictureInSequence& picture, const Vector3& axis, double length) {
  const PixelGrid& grid = picture.grid;
  return {length / grid.pixel, dot(picture.reference - grid.rectangle.origin, axis) / grid.pixel};
}

/// What is half-way between two pixels in many pictures must not go to either by its rounding.
double nearest_whole(double pixels) {
  return std::floor(pixels + 0.5 + kSamePlace);
}

/// From 0 to below 1.
double part_of_pixel(double pixels) {
  const double part = pixels - std::floor(pixels);
  return part < kSamePlace || part > 1.0 - kSamePlace ? 0.0 : part;
}

Shift shift_to(const Side& first, const Side& side) {
  const double from_first = side.reference - first.reference;
  const double wanted = nearest_whole(from_first - 0.5 * (side.length - first.length));
  const double part = part_of_pixel(from_first);
  const double kept = part > side.length ? 0.0 : part;
  return {kept, static_cast<int>(nearest_whole(wanted - (from_first - kept)))};
}

}  // namespace

AlignedPictures align_pictures(std::span<const PictureInSequence> pictures) {
  AlignedPictures aligned;
  if (pictures.empty()) {
    return aligned;
  }
  const auto columns_of = [](const PictureInSequence& picture) {
    return side_along(picture, picture.grid.rectangle.axes.p, picture.grid.rectangle.width);
  };
  const auto rows_of = [](const PictureInSequence& picture) {
    return side_along(picture, picture.grid.rectangle.axes.q, picture.grid.rectangle.height);
  };
  cv::Point least;
  cv::Point most;
  for (const PictureInSequence& picture : pictures) {
    const Shift right = shift_to(columns_of(pictures.front()), columns_of(picture));
    const Shift down = shift_to(rows_of(pictures.front()), rows_of(picture));
    const PixelGrid grid = shifted_grid(picture.grid, right.part, down.part);
    least = {std::min(least.x, right.whole), std::min(least.y, down.whole)};
    most = {std::max(most.x, right.whole + grid.columns), std::max(most.y, down.whole + grid.rows)};
    aligned.pictures.push_back({grid, {right.whole, down.whole}});
  }
  for (AlignedPicture& picture : aligned.pictures) {
    picture.first -= least;
  }
  aligned.size = cv::Size(most - least);
  return aligned;
}

}  // namespace biotomy::reconstruct
