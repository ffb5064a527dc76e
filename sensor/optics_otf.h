#pragma once
// The optical transfer function of the lens for the detector: averaged over the spectral bins, weighted with
// the photo-electrons of a grey sunlit scene.
//
// It is computed from diffraction, obscuration, defocus and wavefront error (mtf.h), or from Zernike
// coefficients (zernike.h), or taken from a measured curve, which is valid for the whole spectrum and 0
// beyond its last point.

#include <complex>
#include <functional>
#include <vector>

#include "render/vocabulary/spectrum.h"
#include "sensor/camera_model.h"

namespace hilcam {

// Properties of the lens that may vary over the field.
struct LensState {
    double defocus_m = 0;
    double wavefront_rms_m = 0;
};

class OpticsOtf {
  public:
    // response: electrons in each bin per unit of radiance (optics.h). Owner thread.
    OpticsOtf(const CameraModel& camera, const SpectralGrid& grid, const Spectrum& response,
              const LensState& lens);
    ~OpticsOtf();
    OpticsOtf(OpticsOtf&&) noexcept;
    OpticsOtf& operator=(OpticsOtf&&) noexcept;

    // u, v: frequencies [cycles/px of the detector].
    std::complex<double> at(double u, double v) const;

  private:
    void tabulate(const std::function<double(double)>& radial);
    struct Bin;
    std::vector<Bin> bins_;  // spectral bins, with their Zernike coefficients
    double last_cy_px_ = 0;  // end of the table; 0 beyond it
    std::vector<double> table_;
};

}  // namespace hilcam
