#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/picture/jpeg_writer.hpp"
#include "reconstruct/picture/picture_notes.hpp"

namespace biotomy::reconstruct {

enum class PictureFormat { png, tiff, jpeg };

/// By the extension: .png, .tif, .tiff, .jpg or .jpeg, in any case of letters. Throws
/// InvalidRequest for others, so that work can be refused before it is done.
PictureFormat picture_format(const std::filesystem::path& path);

/// `image` (CV_8UC3 or CV_16UC3, R G B) as a file with its notes; how each format holds them is
/// told by encode_png, encode_tiff and encode_jpeg, whose errors these are. A JPEG has 8 bits and
/// is not lossless; the others are, and take no `jpeg_quality`.
std::vector<std::byte> encode_section_image(const cv::Mat& image, PictureFormat format,
                                            const PictureNotes& notes,
                                            int jpeg_quality = kDefaultJpegQuality);

/// Stores it durably, as the name's extension says. Throws InvalidRequest for another extension,
/// SampleError when it can't be stored; then a file that was there is still there, whole.
void write_section_image(const std::filesystem::path& path, const cv::Mat& image,
                         const PictureNotes& notes, int jpeg_quality = kDefaultJpegQuality);

}  // namespace biotomy::reconstruct
