#pragma once

#include <array>
#include <cstddef>

namespace biotomy::acquisition {

/// The value of a picture and its derivatives to the second order, as a face is compared by them:
/// value, x, y, xx, yy, xy, by the differences of neighbouring pixels.
inline constexpr std::size_t kDerivatives = 6;
using DerivativeMoments = std::array<std::array<double, kDerivatives>, kDerivatives>;

/// The mean products of these in a print of noise alone (see FacePrint) whose mean square is 1: of
/// noise that is white at half the resolution, in the print's band.
const DerivativeMoments& unit_noise_moments();

}  // namespace biotomy::acquisition
