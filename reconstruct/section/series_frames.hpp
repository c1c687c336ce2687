#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/bricks/brick_source.hpp"
#include "reconstruct/section/frame_canvas.hpp"
#include "reconstruct/section/section.hpp"
#include "reconstruct/section/series.hpp"
#include "reconstruct/section/series_layout.hpp"

namespace biotomy::reconstruct {

/// The background of series.
inline constexpr Colour kGreyBlue{96, 112, 136};

/// What stands below each picture of a series.
struct FrameMarks {
  bool label = true;  ///< its angle or offset
  bool scale_bar = true;
};

/// The pictures of a series, all of one size, laid over each other as series_layout says. Frames
/// may be drawn in any order; drawn in theirs, each finds in the source's cache most chunks that
/// the one before has read.
class SeriesFrames {
 public:
  /// `source` must outlive it. Throws SampleError when no plane of the series cuts the sample, or
  /// the frames would be larger than `style.max_bytes`.
  SeriesFrames(BrickSource& source, Series series, const SectionStyle& style,
               FrameMarks marks = {});

  std::size_t count() const { return series_.frames.size(); }
  cv::Size frame_size() const { return canvas_.size(); }
  double pixel() const { return layout_.pixel; }  ///< micrometres
  int frame_type() const;                         ///< CV_8UC3 or CV_16UC3
  const Series& series() const { return series_; }

  /// The section of a frame, its grid as it is drawn; none as in SeriesLayout.
  const std::optional<SectionOutline>& outline(std::size_t index) const;

  /// The frame's pixel that is pixel (0, 0) of its section, which there must be.
  cv::Point first_pixel(std::size_t index) const;

  /// CV_8UC3 or CV_16UC3, R G B: the section, centred; the background alone where the plane does
  /// not cut the sample; with its marks. The statistics are the section's. `on_rows` is told and
  /// may end it as sample_grid's.
  SampledImage draw(std::size_t index, const OnRows& on_rows = {}) const;

 private:
  /// Below the picture; empty when there is to be none.
  std::string label(std::size_t index) const;

  BrickSource& source_;
  Series series_;
  SectionStyle style_;
  FrameMarks marks_;
  SeriesLayout layout_;
  FrameCanvas canvas_;
};

}  // namespace biotomy::reconstruct
