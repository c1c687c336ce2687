#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

namespace biotomy::sim {

struct Lens {
  double numerical_aperture = 0.1;  ///< on the side of the object
  double wavelength_um = 0.55;
};

/// How wide a point of the face becomes, as the standard deviation of a Gaussian, in micrometres on
/// the face, when it lies `defocus_um` from the focal plane.
///
/// Geometric optics: a cone of rays of half angle asin(NA) that meets the focal plane in a point
/// covers at the distance δ a disc of diameter c = 2·|δ|·tan(asin NA) ≈ 2·NA·|δ| (circle of
/// confusion; e.g. Born & Wolf, Principles of Optics, 4.8). A uniform disc of diameter c has the
/// standard deviation c/4 along each axis.
/// Diffraction: the Airy pattern is close to a Gaussian of 0.225·λ/NA (Zhang, Zerubia &
/// Olivo-Marin, Applied Optics 46 (2007) 1819). The two are added as variances.
double blur_sigma_um(const Lens& lens, double defocus_um);

/// The weights of a row of pixels, of which the middle one becomes the sum, under a blur by a
/// Gaussian of `sigma` pixels: the Gaussian of discrete signals, exp(-σ²)·I_n(σ²) (T. Lindeberg,
/// "Scale-space for discrete signals", IEEE Transactions on Pattern Analysis and Machine
/// Intelligence 12 (1990) 234). A Gaussian that is looked up at the pixels' centres has lost most
/// of its blur when it is narrower than half a pixel, which is where focus is decided.
std::vector<double> blur_weights(double sigma);

/// Blurs a CV_32FC3 picture in place by a Gaussian of `sigma` pixels; its time grows little with
/// sigma. Nothing below a twentieth of a pixel. Up to 4 pixels it leaves exp(-σ²·(1 - cos 2πf)) of
/// the contrast of f cycles per pixel: exp(-σ²) at half the Nyquist frequency.
void blur(cv::Mat& picture, double sigma);

/// The weights of a row of pixels under a movement by `pixels` during the exposure, whole or not.
/// Less than a pixel moves nothing into the next.
std::vector<double> smear_weights(double pixels);

/// Smears a CV_32FC3 picture in place along its rows, as movement by `pixels` during the exposure
/// does.
void smear_along_rows(cv::Mat& picture, double pixels);

/// What is left of the contrast of a wave of 4 pixels, half the Nyquist frequency, under weights
/// of an odd number of pixels, symmetric and of sum 1.
double contrast_at_half_nyquist(const std::vector<double>& weights);

}  // namespace biotomy::sim
