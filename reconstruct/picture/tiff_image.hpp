#pragma once

#include <filesystem>

#include <opencv2/core/mat.hpp>

namespace biotomy::reconstruct {

/// The first image of anybody's TIFF: grey or RGB, with or without further channels, which are
/// dropped; 8 or 16 bits; in strips or tiles; colours together or in planes; any compression that
/// libtiff knows. CV_8UC3 or CV_16UC3, R G B. Throws SampleError.
cv::Mat read_tiff_image(const std::filesystem::path& path);

}  // namespace biotomy::reconstruct
