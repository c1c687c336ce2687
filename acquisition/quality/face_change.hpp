#pragma once

#include <optional>
#include <vector>

#include "acquisition/quality/camera_noise.hpp"
#include "acquisition/quality/face_print.hpp"

namespace biotomy::acquisition {

/// How much the fine detail of a face differs from another's: 0, give or take its error, when it is
/// the same face photographed again; 1 when the two have nothing in common.
struct Change {
  double value = 0.0;
  double error = 0.0;  ///< its standard deviation as the noise alone makes it
};

/// The change between two faces, of each part the upper quartile of its patches: nothing where
/// there is no detail to tell by, as on bare casting material.
struct FaceChange {
  std::optional<Change> whole;
  std::vector<std::optional<Change>> rows;     ///< of patches, from the top
  std::vector<std::optional<Change>> columns;  ///< of patches, from the left
};

/// Compares two prints of frames of one size; of different sizes nothing is judged.
///
/// In each patch the weaker face's detail is fitted by the stronger's and its first and second
/// derivatives: what a shift of up to half a pixel, a little blur and another brightness make of a
/// face is no change. A shift of up to 4 pixels of the half resolution, the same for the whole
/// frame, is found and undone before. The change is the part of the detail's energy that is left
/// over, with every sum's share of noise taken out: the same sums over the prints' noise. Detail
/// that has faded below a quarter of its energy, or come from there, counts as wholly changed.
///
/// `noise` is what is known of the noise of both, where it is not white; without it the prints'
/// own is taken out.
FaceChange measure_face_change(const FacePrint& now, const FacePrint& before,
                               const std::optional<BandNoise>& noise = std::nullopt);

}  // namespace biotomy::acquisition
