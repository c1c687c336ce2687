#pragma once

#include <opencv2/core/mat.hpp>

#include "firmware_bridge/wire/transfer.hpp"

namespace biotomy::acquisition {

/// Flat-field and dark-field correction of frames of one size and kind:
///
///   corrected = (frame − dark) · mean(flat − dark) / (flat − dark)
///
/// for each pixel and colour, the mean over the frame for each colour, so that neither brightness
/// nor colour change on the whole; e.g. Seibert, Boone and Lindfors, "Flat-field correction
/// technique for digital detectors", Proc. SPIE 3336 (1998) 348-354. It holds for values in
/// proportion to the light: those of frames that follow it by a curve are made such values, and
/// coded by the same curve again. Rounded to the nearest level; what becomes negative is 0. A value
/// that is clipped (see ClippingLevels) becomes full scale, whatever the flat field says: what was
/// clipped must be seen to be.
class FieldCorrection {
 public:
  /// Of the flat field's mean. A pixel that got less of the light than this part is amplified no
  /// further: there is no picture in it.
  static constexpr double kLeastLight = 0.25;

  /// `flat` and `dark` are means of light, CV_16UC3, 65535 is full scale, of one size; either may
  /// be empty: nothing of that kind is corrected. `type` is that of the frames, CV_8UC3 or
  /// CV_16UC3, and `transfer` how they follow the light.
  FieldCorrection(const cv::Mat& flat, const cv::Mat& dark, int type, bridge::Transfer transfer);

  bool fits(cv::Size size) const { return size == size_; }

  /// Corrects in place an image of that size and type, with all cores. Needs 2 bytes a value, and
  /// 2 more with a dark field, beside the image.
  void apply(cv::Mat& image) const;

 private:
  int type_;
  bridge::Transfer transfer_;
  cv::Size size_;
  cv::Mat gain_;  ///< CV_16UC3, 1 is 2^14
  cv::Mat dark_;  ///< CV_16UC3; for linear frames of 8 bits a level is 256; empty without one
};

}  // namespace biotomy::acquisition
