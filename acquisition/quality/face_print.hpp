#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "acquisition/quality/brightness_plane.hpp"
#include "acquisition/quality/frame_rows.hpp"

namespace biotomy::acquisition {

/// What is kept of a photograph of a face to tell later whether another photograph shows the same
/// face: a few patches of its fine detail, spread over the frame, at half its resolution.
///
/// Of each 2 × 2 pixels the two diagonals are two images of one scene whose noise has nothing in
/// common. Half their sum is the detail with its noise, half their difference is noise of the very
/// same strength without the detail, so that all that noise does to a measure can be taken out of
/// it. Both are band-passed (a Gaussian of 1 less one of 4 pixels of the half resolution): what
/// lighting does is broader, what noise does is finer.
struct FacePrint {
  struct Patch {
    cv::Mat detail;           ///< CV_32FC1, of full scale, with its noise
    cv::Mat noise;            ///< likewise, the noise alone, if it is white
    double brightness = 0.0;  ///< mean, of full scale
  };

  /// How far a patch reaches beyond its core on all sides, pixels of the half resolution.
  static constexpr int kReach = 5;
  /// The longest side of a patch's core, likewise.
  static constexpr int kMostCore = 96;

  int columns = 0;             ///< of patches
  int rows = 0;                ///< of patches; both 0 when the frame is too small
  std::vector<Patch> patches;  ///< row by row
  std::shared_ptr<const FrameRows> frame_rows;

  const Patch& patch(int column, int row) const {
    return patches[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(column)];
  }
};

/// `image` is CV_8UC3 or CV_16UC3, R G B. Frames of one size have patches at the same places: at
/// most 8 × 8 in all.
FacePrint take_face_print(const cv::Mat& image);

/// The band of a CV_32FC1 at half the resolution, of it the part `wanted`.
cv::Mat print_band(const cv::Mat& half, const cv::Rect& wanted);

/// The mean square of the detail that a print of this picture has in its middle, where its edges do
/// not matter; nothing when it is too small for that or has pixels that do not count.
std::optional<double> print_energy(const BrightnessPlane& plane);

}  // namespace biotomy::acquisition
