#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/picture/picture_notes.hpp"

namespace biotomy::reconstruct {

inline constexpr int kDefaultJpegQuality = 90;
inline constexpr int kLongestJpegSide = 65500;  ///< pixels

/// `rgb` (CV_8UC3, or CV_16UC3 that is cut to 8 bits; R G B) as a JPEG file for looking at, with
/// colours at full resolution. `quality` is 1 to 100. The description becomes a comment. JFIF
/// knows the density in whole pixels a centimetre or an inch alone, up to 65535: whichever is
/// nearer is written, if it is true to 1 %, and none otherwise; the description has the exact size.
/// Throws InvalidRequest for a picture of no pixels or of another type and for another quality,
/// SampleError for a picture or a description that is too large for a JPEG.
std::vector<std::byte> encode_jpeg(const cv::Mat& rgb, const PictureNotes& notes, int quality);

}  // namespace biotomy::reconstruct
