#pragma once

#include <filesystem>

#include <opencv2/core/mat.hpp>

#include "reconstruct/picture/tiff_pages.hpp"

namespace biotomy::reconstruct {

/// The only picture of anybody's TIFF: grey or RGB, with or without further channels, which are
/// dropped; 8 or 16 bits; in strips or tiles; colours together or in planes; any compression that
/// libtiff knows. CV_8UC3 or CV_16UC3, R G B. Throws SampleError, also for a file of several.
cv::Mat read_tiff_image(const std::filesystem::path& path);

/// One page of such a file. Throws SampleError.
cv::Mat read_tiff_page(const std::filesystem::path& path, TiffPage page);

}  // namespace biotomy::reconstruct
