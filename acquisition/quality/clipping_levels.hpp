#pragma once

#include <array>

#include <opencv2/core/mat.hpp>

namespace biotomy::acquisition {

/// The least value of each colour, R G B, that counts as clipped in an image, of its samples'
/// scale.
///
/// Full scale always does. What a camera clips may come out below it: at the end of a converter of
/// 10, 12 or 14 bits whose values are stored in 16, shifted or not, or at the levels about a
/// plateau that JPEG makes of it. So a colour's values that pile up near the end of the scale count
/// as clipped too. They pile up where one value is four times as frequent as any just below it, as
/// the smooth tail of a picture without saturation never is; in 8 bits also where the last six
/// levels hold four times what the six before them do, up to the very last ones. Near is within six
/// 256ths of the scale; the scale is the shortest of such a converter, or of the samples, that no
/// value exceeds.
///
/// A surface that lies so near the end without being clipped is told from a clipped one by its
/// noise, and taken for one when it has less than half a level. A saturation that was smeared, by a
/// later correction or because the sensor's wells and not its converter were full, is not seen.
using ClippingLevels = std::array<int, 3>;

/// `image` is CV_8UC3 or CV_16UC3, R G B. Of a large one every nth row is looked at, 512 or more.
ClippingLevels clipping_levels(const cv::Mat& image);

template <typename Sample>
bool is_clipped(const Sample* pixel, const ClippingLevels& levels) {
  return pixel[0] >= levels[0] || pixel[1] >= levels[1] || pixel[2] >= levels[2];
}

}  // namespace biotomy::acquisition
