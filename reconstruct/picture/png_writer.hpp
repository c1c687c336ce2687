#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/picture/picture_notes.hpp"

namespace biotomy::reconstruct {

/// `rgb` (CV_8UC3 or CV_16UC3, R G B) as a PNG file. The notes become pHYs, to the whole pixel a
/// metre, where it can say so, and iTXt Title, Description and Software. Strips of rows are
/// filtered and deflated in parallel; the bytes do not depend on how many threads there are.
/// Throws InvalidRequest for a picture of no pixels or of another type.
std::vector<std::byte> encode_png(const cv::Mat& rgb, const PictureNotes& notes);

}  // namespace biotomy::reconstruct
