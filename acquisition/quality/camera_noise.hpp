#pragma once

#include <optional>

#include "acquisition/quality/detail_energy.hpp"
#include "acquisition/quality/frame_measures.hpp"

namespace biotomy::acquisition {

/// What noise adds to the energy of a band, along each axis: one part of it is there without light,
/// the other grows with the light, as the electrons' shot noise does.
struct BandNoise {
  double dark = 0.0;
  double light = 0.0;  ///< at full brightness

  double at(double brightness) const { return dark + light * brightness; }
};

/// The noise of a camera's frames, band by band.
///
/// White noise is told from every frame alone (measure_frame). But where colours were interpolated
/// from a mosaic of red, green and blue pixels, or a picture was sharpened, smoothed or compressed,
/// its noise is no longer white: of a grey surface through such a mosaic, interpolated linearly,
/// the gradient has 14 times what white noise would add that is as strong under Immerkær's kernel,
/// and it would be taken for detail.
struct CameraNoise {
  PerBand<BandNoise> bands;  ///< of the tiles' detail
  /// Of a FacePrint's detail; nothing when the frames were too small.
  std::optional<BandNoise> face;
};

/// Whether gradient and curvature have it in the proportion of white noise, within a half.
bool is_white(const CameraNoise& noise);

/// Of two frames of one face, taken one after the other while nothing moved: what they do not share
/// is noise, whatever the camera made of it. So the photon transfer method finds a sensor's noise
/// (EMVA Standard 1288, the temporal noise by the difference of two images), here of each tile and
/// band, as a line over the tiles' brightness. The tiles count by the inverse square of the band's
/// energy in them: where there is much detail, a movement by a part of a pixel between the two adds
/// to their difference, and noise changes least. Nothing when the frames are not of one size, or
/// too small.
std::optional<CameraNoise> noise_between(const FrameMeasures& one, const FrameMeasures& other);

/// The same measures, with this noise; if it is white, with what each tile tells of itself.
FrameMeasures with_noise(const FrameMeasures& measures, const CameraNoise& noise);

}  // namespace biotomy::acquisition
