#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/picture/picture_notes.hpp"

namespace biotomy::reconstruct {

/// `rgb` (CV_8UC3 or CV_16UC3, R G B) as a TIFF file of strips, deflated in parallel after the
/// horizontal predictor: what every ordinary reader opens. The notes become the resolution in
/// pixels per centimetre, DocumentName, ImageDescription and Software. A BigTIFF where 4 GiB could
/// be too little. Throws InvalidRequest for a picture of no pixels or of another type, SampleError
/// when the file can't be put together.
std::vector<std::byte> encode_tiff(const cv::Mat& rgb, const PictureNotes& notes);

}  // namespace biotomy::reconstruct
