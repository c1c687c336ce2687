#pragma once

#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>

#include "acquisition/calibration/mean_frame.hpp"

namespace biotomy::acquisition {

// Whether frames are fit for a calibration: nothing when they are, else what is wrong with them and
// what to do, in one sentence. Brightness is the light, of full scale.

/// A flat field is of an even, pale surface: bright enough, not clipped, the light not worse than
/// four to one over the frame, and without a pattern of its own.
std::optional<std::string> flat_complaint(const MeanFrame& frames);

/// A dark field is dark.
std::optional<std::string> dark_complaint(const MeanFrame& frames);

/// A grey card fills the middle half of the frame: bright enough and not clipped.
std::optional<std::string> white_complaint(const MeanFrame& frames);

/// The middle half of an image along both sides, where the grey card is.
cv::Mat middle_half(const cv::Mat& image);

}  // namespace biotomy::acquisition
