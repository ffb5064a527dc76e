#pragma once
// Single modulation transfer functions. Frequencies are in cycles per pixel along the image axes. All are 1
// at zero frequency; a defocused lens can be negative (reversed contrast).

#include "sensor/exposure.h"

namespace hilcam {

// Returns the diffraction OTF of a circular pupil with central obscuration and defocus at one wavelength: the
// autocorrelation of the pupil function (Goodman, Introduction to Fourier Optics, 3rd ed., 6.3-6.4),
// integrated in closed form across the shift and by Simpson's rule along it. A defocus of dz gives the
// wavefront W20 = dz / (8 N^2) at the pupil's edge (Hopkins, Proc. R. Soc. A 231, 1955). Error below 2e-4.
//   shift: 0 .. 2 in pupil radii, = 2 nu lambda N; beyond 2 the result is 0.
double pupil_otf(double shift, double obscuration_ratio, double defocus_waves);

// Returns the share of the diffraction MTF that remains with random aberrations, by Shannon's empirical
// formula
//     1 - (W / 0.18)^2 (1 - 4 (s / 2 - 1/2)^2)
// (Shannon, The Art and Science of Optical Design, 1997, ch. 3), with W the rms wavefront error in waves.
// Published for W up to 0.18; not below zero.
double aberration_mtf(double shift, double wavefront_rms_waves);

// Returns sin(pi x) / (pi x).
double sinc(double x);

// Returns the MTF of a Gaussian blur with a standard deviation [px].
double gaussian_mtf(double frequency_cy_px, double sigma_px);

// Returns the MTF of crosstalk, where each pixel loses a fraction c of its charge to each of its four
// neighbours: 1 - 2 c (2 - cos 2 pi u - cos 2 pi v).
double crosstalk_mtf(double u, double v, double fraction);

// Returns the MTF of sampling each pixel on a regular grid with n rays along an axis: sin(pi f) / (n sin(pi f
// / n)), the Dirichlet kernel; 1 for n = 1, the unit box for n to infinity and for kScatteredRays. MTF_sys is
// divided by it, so that ray grid and pixel aperture together count once. halved(n) has that of n;
// moment_kernels.h does the rest.
double ray_grid_mtf(double frequency_cy_px, RayGrid rays);
// Returns the same for half a pixel, which has n / 2 rays of halved(n) along the axis.
double half_rays_mtf(double frequency_cy_px, RayGrid rays);

}  // namespace hilcam
