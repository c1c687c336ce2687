#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace biotomy::acquisition {

/// A sweep that cannot be ranked; the message says why.
class UnfitSweep : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One frame of a sweep.
struct SweepFrame {
  double focus = 0.0;       ///< its fine detail, relative to the sharpest frame's
  double error = 0.0;       ///< standard error of `focus` from noise
  int sharpest_tiles = 0;   ///< tiles that are sharpest in this frame, of those that show it
  double clipped = 0.0;     ///< part of its pixels
  double brightness = 0.0;  ///< relative to the sweep's mean
};

struct SweepRanking {
  std::vector<SweepFrame> frames;
  std::size_t sharpest = 0;
  /// Whether noise alone could hardly have put it before every other frame.
  bool certain = false;
  /// Where the focus is between the frames, in frames from 0; none when the sharpest is the first
  /// or the last: then it may lie beyond.
  std::optional<double> peak;
  int detail_px = 0;    ///< length of the waves that were compared, pixels
  double usable = 0.0;  ///< part of the area that was compared
};

/// Ranks frames of one field at several focus positions, in their order. `read` gives a frame,
/// CV_8UC3 or CV_16UC3, R G B, all of one size and kind; it is called twice for each and one frame
/// is held at a time.
///
/// What is compared is the energy of the fine detail, free of noise (see SharedDetail) and of
/// clipped spots (see SweepMask), with the brightness of the sweep's frames made equal, summed over
/// the tiles: a tile counts by the detail that it has, so that empty tiles have no say, and in a
/// field with depth the frame wins that resolves most. Second differences and not gradients: a
/// coarse edge that moves or grows as the magnification breathes does not outweigh fine detail.
/// The finest scale is taken at which the sweep stands out from the noise.
///
/// Throws UnfitSweep for fewer than two frames, frames of different sizes, and where nothing can be
/// compared; and what `read` throws.
SweepRanking rank_sweep(std::size_t frames, const std::function<cv::Mat(std::size_t)>& read);

}  // namespace biotomy::acquisition
