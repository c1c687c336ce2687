#pragma once

#include <optional>
#include <vector>

#include <opencv2/core/types.hpp>

#include "reconstruct/section/section.hpp"
#include "reconstruct/section/series.hpp"

namespace biotomy::reconstruct {

/// The sections of a series, and how their pictures lie over each other: centred to within a pixel,
/// with the series' reference on the same part of a pixel in every frame. A custom rectangle is
/// left where it was asked for.
struct SeriesLayout {
  std::vector<std::optional<SectionOutline>> outlines;  ///< none where a plane has no section
  std::vector<cv::Point> places;  ///< where pixel (0, 0) of an outline lies, if there is one
  cv::Size size;                  ///< that holds all pictures
  double pixel = 0.0;             ///< micrometres
};

/// Throws SampleError when no plane of the series cuts the cuboid, or a picture would be larger
/// than `style.max_bytes`.
SeriesLayout series_layout(const Cuboid& cuboid, int bits, const Series& series,
                           const SectionStyle& style);

}  // namespace biotomy::reconstruct
