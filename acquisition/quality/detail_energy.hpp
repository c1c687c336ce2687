#pragma once

#include <array>
#include <cstddef>

#include <opencv2/core/types.hpp>

#include "acquisition/quality/brightness_plane.hpp"

namespace biotomy::acquisition {

/// The mean square of a derivative of the brightness, along both axes. In (full scale per pixel)²,
/// a pixel of the level it was measured at. With what noise adds taken out it may be a little below
/// zero where there is no detail.
struct DetailEnergy {
  double along_x = 0.0;
  double along_y = 0.0;

  double sum() const { return along_x + along_y; }
};

/// By what detail is told apart, from the finest on.
enum class DetailBand {
  curvature,  ///< the second derivative of the picture
  fine,       ///< the gradient of the picture: strongest at 1/4 cycle per pixel
  middle,     ///< of the picture at half its resolution: at 1/8
  coarse,     ///< at a quarter: at 1/16
};
inline constexpr std::size_t kDetailBands = 4;

/// Something of each band.
template <typename Value>
struct PerBand {
  std::array<Value, kDetailBands> values{};

  Value& operator[](DetailBand band) { return values[static_cast<std::size_t>(band)]; }
  const Value& operator[](DetailBand band) const { return values[static_cast<std::size_t>(band)]; }
};

/// What white noise of variance 1 adds to a band's energy, along each axis.
inline constexpr PerBand<double> kWhiteNoise{{6.0, 3.0 / 16.0, 3.0 / 64.0, 3.0 / 256.0}};

/// What white noise of a variance adds.
inline PerBand<double> white_noise(double variance) {
  PerBand<double> noise = kWhiteNoise;
  for (double& band : noise.values) band *= variance;
  return noise;
}

struct MeasuredDetail {
  PerBand<DetailEnergy> energy;  ///< with the noise still in it
  double noise_variance = 0.0;   ///< if the noise is white
};

/// Measures a part of a picture, again and again; what it needs of memory it keeps.
///
/// Second derivatives are the differences 1, -2, 1. Gradients are Sobel's (3 × 3, an eighth of the
/// sum), whose response to a wave along the axis is sin(2πf): greatest at half the Nyquist
/// frequency. Levels are means of 2 × 2 pixels. The noise is estimated after Immerkær, "Fast noise
/// variance estimation", Computer Vision and Image Understanding 64 (1996) 300-302, with the mean
/// of squares in place of the mean of amounts.
class DetailMeasurer {
 public:
  /// How far derivatives reach beyond a part, in pixels: one pixel of the coarsest level and one
  /// for the gradient there.
  static constexpr int kReach = 8;

  /// Of `plane` the pixels in `part`; those on its border have no derivatives and are left out.
  MeasuredDetail measure(const BrightnessPlane& plane, const cv::Rect& part);

 private:
  BrightnessPlane middle_;
  BrightnessPlane coarse_;
};

}  // namespace biotomy::acquisition
