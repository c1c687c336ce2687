#pragma once

#include <span>
#include <vector>

#include "acquisition/focus/detail.hpp"
#include "acquisition/focus/parabola_fit.hpp"

namespace biotomy::acquisition {

/// What a parabola is fitted to: the logarithm of the detail along a bracket, x the number of the
/// frame from 0.
///
/// Defocus by δ is, near the focus, a blur whose variance grows with δ² (geometric optics), and a
/// blur of variance s² leaves exp(−4π²s²f²) of the energy of a wave of frequency f: its logarithm
/// is a parabola in δ, of the energy itself only the very top is. A frame has its say by its share
/// of the greatest energy, squared: noise of the energy is magnified so much by the logarithm, and
/// far from the focus the coarse waves that are left make the curve shallower.
std::vector<MeasuredPoint> focus_curve(std::span<const Detail> along_the_bracket);

}  // namespace biotomy::acquisition
