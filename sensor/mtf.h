#pragma once
// Modulation transfer functions, each by itself. Frequencies in cycles per pixel along the image axes; 1 at
// zero frequency; a defocused lens may go below zero (reversed contrast).

#include "sensor/exposure.h"

namespace hilcam {

// Diffraction OTF of a circular pupil with a central obscuration and defocus, at one wavelength:
// autocorrelation of the pupil function (Goodman, Introduction to Fourier Optics, 3rd ed., 6.3-6.4), whose
// integral across the shift is done in closed form and along it by Simpson's rule. Defocus dz gives the
// wavefront W20 = dz / (8 N^2) at the pupil's edge (Hopkins, Proc. R. Soc. A 231, 1955). Error below 2e-4.
//   shift: 0 .. 2 in pupil radii, = 2 nu lambda N; beyond 2 the result is 0.
double pupil_otf(double shift, double obscuration_ratio, double defocus_waves);

// Returns the share of the diffraction MTF that random aberrations of a wavefront error leave: Shannon's
// empirical formula
//     1 - (W / 0.18)^2 (1 - 4 (s / 2 - 1/2)^2)
// (Shannon, The Art and Science of Optical Design, 1997, ch. 3), W the error in waves rms. Published for W up
// to 0.18; not below zero.
double aberration_mtf(double shift, double wavefront_rms_waves);

// sin(pi x) / (pi x)
double sinc(double x);

// Gaussian blur of a standard deviation [px].
double gaussian_mtf(double frequency_cy_px, double sigma_px);

// Charge that each pixel loses to its four neighbours (fraction c to each): 1 - 2 c (2 - cos 2 pi u - cos 2
// pi v).
double crosstalk_mtf(double u, double v, double fraction);

// Returns what sampling each pixel on a regular grid of n rays along an axis has already done to the image:
// sin(pi f) / (n sin(pi f / n)), the Dirichlet kernel; 1 for n = 1, the unit box for n to infinity and for
// kScatteredRays. MTF_sys divides by it, so that ray grid and pixel aperture together count once. Of halved(n) as
// of n; the rest is moment_kernels.h's.
double ray_grid_mtf(double frequency_cy_px, RayGrid rays);
// Returns the same of half a pixel, which has n / 2 of the rays of halved(n) along it.
double half_rays_mtf(double frequency_cy_px, RayGrid rays);

}  // namespace hilcam
