#pragma once

#include <filesystem>

#include <opencv2/core/mat.hpp>

namespace biotomy::reconstruct {

enum class PictureFormat { png, tiff };

/// By the extension: .png, .tif or .tiff, in any case of letters. Throws InvalidRequest for others,
/// so that work can be refused before it is done.
PictureFormat picture_format(const std::filesystem::path& path);

/// Stores `image` (CV_8UC3 or CV_16UC3, R G B) durably, with the size of a pixel in micrometres in
/// the file (PNG: pHYs; TIFF: resolution in pixels per centimetre, to the whole pixel).
/// Throws InvalidRequest for another extension, SampleError when it can't be stored; then a file
/// that was there is still there, whole.
void write_section_image(const std::filesystem::path& path, const cv::Mat& image, double pixel);

}  // namespace biotomy::reconstruct
