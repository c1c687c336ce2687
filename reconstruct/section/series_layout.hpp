#pragma once

#include <exception>
#include <optional>
#include <vector>

#include <opencv2/core/types.hpp>

#include "reconstruct/section/section.hpp"
#include "reconstruct/section/series.hpp"

namespace biotomy::reconstruct {

/// The section of a frame by itself.
struct FrameOutline {
  /// None where the plane does not cut the cuboid, or its polygon has no rectangle as it was asked
  /// for: it lacks the edge, or is too thin.
  std::optional<SectionOutline> outline;
  std::exception_ptr refusal;  ///< what theta_rectangle threw, if it did
};

/// Throws SampleError when the picture would be larger than `style.max_bytes`.
FrameOutline frame_outline(const SeriesFrame& frame, const Cuboid& cuboid, int bits,
                           const SectionStyle& style);

/// The sections of a series, and how their pictures lie over each other: centred to within a pixel,
/// with the series' reference on the same part of a pixel in every frame. A custom rectangle is
/// left where it was asked for.
struct SeriesLayout {
  std::vector<std::optional<SectionOutline>> outlines;  ///< as FrameOutline has them
  std::vector<cv::Point> places;  ///< where pixel (0, 0) of an outline lies, if there is one
  cv::Size size;                  ///< that holds all pictures
  double pixel = 0.0;             ///< micrometres
};

/// Throws SampleError when no plane of the series cuts the cuboid, what theta_rectangle throws when
/// none of those that do has a rectangle as it was asked for, SampleError when a picture would be
/// larger than `style.max_bytes`.
SeriesLayout series_layout(const Cuboid& cuboid, int bits, const Series& series,
                           const SectionStyle& style);

}  // namespace biotomy::reconstruct
