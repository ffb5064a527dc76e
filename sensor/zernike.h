#pragma once
// Optical transfer function of a pupil with a wavefront in Zernike polynomials.
//
// The polynomials have Noll's order and scale, with root mean square 1 over the full disk (Noll, J. Opt. Soc.
// Am. 66, 207, 1976), so a coefficient is the wavefront error of its term, in the coefficient's unit. Angles
// count from the image's +x towards its +y. The OTF is the autocorrelation of the pupil function (Goodman,
// Introduction to Fourier Optics, 3rd ed., 6.3), by FFT of a pupil of 256 samples across with smoothed edges;
// error below 2e-3. Positive coefficients retard.

#include <complex>
#include <span>
#include <vector>

namespace hilcam {

// Returns Noll's polynomial j = 1, 2, ... at a point of the unit disk.
double zernike(int noll, double x, double y);

// The transfer function of a pupil at one wavelength.
class PupilTransfer {
  public:
    // waves: rms coefficients of Noll's 4, 5, ... [waves]. defocus_waves: W20 as in pupil_otf(). Owner
    // thread.
    PupilTransfer(double obscuration_ratio, double defocus_waves, std::span<const double> waves);
    // shift_x, shift_y: in pupil radii; the result is 0 beyond 2.
    std::complex<double> at(double shift_x, double shift_y) const;

  private:
    std::vector<std::complex<float>> otf_;
};

}  // namespace hilcam
