#pragma once
// The lens as the detector sees it: its optical transfer function averaged over the spectral bins, with the
// photo-electrons of a grey sunlit scene as weights.
//
// From diffraction, obscuration, defocus and wavefront error (mtf.h), from Zernike coefficients (zernike.h),
// or from a measured curve, which holds for all of the spectrum and is 0 beyond its last point.

#include <complex>
#include <functional>
#include <vector>

#include "render/vocabulary/spectrum.h"
#include "sensor/camera_model.h"

namespace hilcam {

// The lens's state holds what may differ over the field.
struct LensState {
    double defocus_m = 0;
    double wavefront_rms_m = 0;
};

class OpticsOtf {
  public:
    // response: electrons of each bin per unit of radiance (optics.h). Owner thread.
    OpticsOtf(const CameraModel& camera, const SpectralGrid& grid, const Spectrum& response,
              const LensState& lens);
    ~OpticsOtf();
    OpticsOtf(OpticsOtf&&) noexcept;
    OpticsOtf& operator=(OpticsOtf&&) noexcept;

    // Frequencies [cycles/px of the detector].
    std::complex<double> at(double u, double v) const;

  private:
    void tabulate(const std::function<double(double)>& radial);
    struct Bin;
    std::vector<Bin> bins_;  // spectral bins, with their Zernike coefficients
    double last_cy_px_ = 0;  // end of the table; 0 from there on
    std::vector<double> table_;
};

}  // namespace hilcam
