#pragma once

#include <filesystem>

#include <opencv2/core/mat.hpp>

#include "reconstruct/picture/tiff_pages.hpp"

namespace biotomy::reconstruct {

/// Whether the name ends like a photograph that read_image_file takes: .png, .tif, .tiff, .jpg,
/// .jpeg, in capitals or not.
bool is_image_name(const std::filesystem::path& path);

/// Whether it is one of them that ends like a TIFF.
bool is_tiff_name(const std::filesystem::path& path);

/// Anybody's photograph as CV_8UC3 or CV_16UC3, R G B. Grey becomes R = G = B. Transparency is
/// dropped and the colours are kept as they are stored, also where nothing of them would be seen:
/// what was photographed is not blended with a background that was not. A CMYK JPEG is refused. A
/// JPEG's orientation tag is not obeyed: the pixels stay where they are. Throws SampleError, naming
/// the file, when it is missing, truncated, damaged or of another kind; never gives half an image.
cv::Mat read_image_file(const std::filesystem::path& path);

/// A page of a TIFF in the same way.
cv::Mat read_image_page(const std::filesystem::path& path, TiffPage page);

}  // namespace biotomy::reconstruct
