#pragma once

#include <optional>

#include <opencv2/core/mat.hpp>

namespace biotomy::acquisition {

/// The colour of the casting material that surrounds the sample, learnt from frames: nothing about
/// it is configured.
struct CastingColour {
  cv::Vec3d level{};       ///< R, G, B of full scale: the median of its cells
  double share = 0.0;      ///< of the frame's cells that show it
  double tolerance = 0.0;  ///< by how much its chroma may differ; see casting_cells

  double brightness() const { return 0.25 * level[0] + 0.5 * level[1] + 0.25 * level[2]; }
};

/// Learns it from the border of a thumbnail (CV_32FC3), where it is nearly always seen: the colour
/// that most of the border's cells have, if at least 6 in 10 have the same. Nothing otherwise.
std::optional<CastingColour> learn_casting(const cv::Mat& thumbnail);

/// Which cells of a thumbnail show casting material: 255 or 0, CV_8UC1. Such a cell has its chroma,
/// r/(r+g+b) and g/(r+g+b), within the tolerance, which is four times the spread over the border
/// (but between 0.012 and 0.04), and between a half and twice its brightness, since shadows and
/// vignetting darken it.
cv::Mat casting_cells(const cv::Mat& thumbnail, const CastingColour& casting);

/// The colour as the cells of `mask` have it in a thumbnail, with the tolerance of `before`.
/// Nothing when they are fewer than 1 in 50 of the frame, or fewer than 16.
std::optional<CastingColour> casting_within(const cv::Mat& thumbnail, const cv::Mat& mask,
                                            const CastingColour& before);

}  // namespace biotomy::acquisition
