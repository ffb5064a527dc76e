#pragma once
// Modulation transfer functions. Frequencies in cycles per pixel along the image axes; values are real (the
// optics are symmetric about the axis), 1 at zero frequency; a defocused lens may go below zero (reversed
// contrast).

#include <span>
#include <vector>

#include "render/spectrum.h"
#include "sensor/camera_model.h"

namespace hilcam {

// Diffraction OTF of a circular pupil with a central obscuration and defocus, at one wavelength:
// autocorrelation of the pupil function (Goodman, Introduction to Fourier Optics, 3rd ed., 6.3-6.4), whose
// integral across the shift is done in closed form and along it by Simpson's rule. Defocus dz gives the
// wavefront W20 = dz / (8 N^2) at the pupil's edge (Hopkins, Proc. R. Soc. A 231, 1955). Error below 2e-4.
//   shift: 0 .. 2 in pupil radii, = 2 nu lambda N; beyond 2 the result is 0.
double pupil_otf(double shift, double obscuration_ratio, double defocus_waves);

// sin(pi x) / (pi x)
double sinc(double x);

// The camera's optics, averaged over the bins with the photo-electrons of a grey sunlit scene as weights.
// Tabulated over radial frequency at construction.
class OpticsMtf {
  public:
    OpticsMtf(const CameraModel& camera, const SpectralGrid& grid);
    // Radial frequency [cycles/px].
    double at(double frequency_cy_px) const;
    // Nothing passes from here on [cycles/px].
    double cutoff_cy_px() const { return cutoff_cy_px_; }

  private:
    double cutoff_cy_px_ = 0;
    std::vector<double> table_;
};

// The light-sensitive square of a pixel along one axis.
double pixel_aperture_mtf(double frequency_cy_px, double fill_factor);

// What sampling each pixel on a regular grid of n rays along an axis has done to the image already:
// sin(pi f) / (n sin(pi f / n)), the Dirichlet kernel; 1 for n = 1, the unit box for n to infinity. MTF_sys
// divides by it, so that ray grid and pixel aperture together count once.
double ray_grid_mtf(double frequency_cy_px, int samples_per_axis);

}  // namespace hilcam
