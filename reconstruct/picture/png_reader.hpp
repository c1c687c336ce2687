#pragma once

#include <cstddef>
#include <span>

#include <opencv2/core/mat.hpp>

namespace biotomy::reconstruct {

/// A PNG file in memory as CV_8UC3 or CV_16UC3, R G B: grey becomes R = G = B, palettes are
/// resolved, less than 8 bits are spread over 8, transparency is dropped; gamma and colour profiles
/// change nothing. Its checksums are not looked at: png_damage does that.
/// Throws SampleError that says what is wrong, and leaves the file's name to the caller.
cv::Mat decode_png(std::span<const std::byte> file);

}  // namespace biotomy::reconstruct
