#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/section/brick_source.hpp"
#include "reconstruct/section/frame_canvas.hpp"
#include "reconstruct/section/section.hpp"
#include "reconstruct/section/series.hpp"

namespace biotomy::reconstruct {

/// The background of series.
inline constexpr Colour kGreyBlue{96, 112, 136};

/// The pictures of a series, all of one size. Frames may be drawn in any order; drawn in theirs,
/// each finds in the source's cache most chunks that the one before has read.
class SeriesFrames {
 public:
  /// `source` must outlive it. Throws SampleError when no plane of the series cuts the sample, or
  /// the frames would be larger than `style.max_bytes`.
  SeriesFrames(BrickSource& source, Series series, const SectionStyle& style);

  std::size_t count() const { return series_.frames.size(); }
  cv::Size frame_size() const { return canvas_.size(); }
  double pixel() const { return pixel_; }  ///< micrometres
  const Series& series() const { return series_; }

  /// CV_8UC3 or CV_16UC3, R G B: the section, centred; the background alone where the plane does
  /// not cut the sample; with its label.
  cv::Mat draw(std::size_t index) const;

 private:
  BrickSource& source_;
  Series series_;
  SectionStyle style_;
  std::vector<std::optional<PixelGrid>> grids_;  // none where the plane does not cut the sample
  double pixel_ = 0.0;
  FrameCanvas canvas_;
};

}  // namespace biotomy::reconstruct
