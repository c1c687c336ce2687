#pragma once

#include <cstddef>
#include <span>

#include <opencv2/core/mat.hpp>

namespace biotomy::reconstruct {

/// Bytes between the pixels' data and the next marker. They are left over where the data before
/// them is damaged; and many cameras put some there.
enum class ExtraneousBytes { are_damage, are_ignored };

/// A JPEG file in memory as CV_8UC3, R G B: grey becomes R = G = B, CMYK is refused. Whatever else
/// libjpeg warns of is an error, since JPEG has no checksum that would tell damage better.
/// Throws SampleError that says what is wrong, and leaves the file's name to the caller.
cv::Mat decode_jpeg(std::span<const std::byte> file,
                    ExtraneousBytes extraneous = ExtraneousBytes::are_damage);

}  // namespace biotomy::reconstruct
