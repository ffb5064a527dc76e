#pragma once
// The sensor: radiance image in, digital numbers out. Equation (2) of Peng et al. 2011,
//     DN = { IFT[ FT(S(L)) MTF_sys ] + noise } G,
// with S: optics.h, MTF_sys: mtf.h, the FFT pair: convolve.h, points beside the image: psf.h, noise and G:
// noise.h.

#include <memory>
#include <span>

#include "render/image.h"
#include "render/point_source.h"
#include "render/random.h"
#include "sensor/camera_model.h"

namespace hilcam {

// Milliseconds of the last frame.
struct SensorTimes {
    double collapse_ms = 0;  // S: radiance to electrons
    double convolve_ms = 0;  // FFT pair and MTF
    double points_ms = 0;    // crop, dark current, point sources
    double digitise_ms = 0;  // noise, gain, ADC
};

class SensorChain {
  public:
    // guard_px: the radiance image's border on each side; samples_per_axis: the renderer's ray grid. Plans
    // the FFT.
    SensorChain(const CameraModel& camera, const SpectralGrid& grid, int guard_px, int samples_per_axis);
    ~SensorChain();

    // Mean charge after one exposure [e-], dark current included; finite and not negative. Loop, one thread
    // at a time.
    void expose(const RadianceImage& radiance, std::span<const PointSource> points, double exposure_s,
                ElectronImage& mean_e);
    // Adds noise and converts. Loop, one thread at a time.
    void digitise(const ElectronImage& mean_e, double gain_db, RandomKey key, DnImage& frame);

    const SensorTimes& times() const { return times_; }
    // MTF_sys along one axis at the Nyquist frequency (0.5 cycles/px), optics times pixel aperture.
    double mtf_at_nyquist() const;
    // Time of one bare FFT pair of the frame's size [ms]; for `hilcam bench`.
    double fft_pair_ms();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
    SensorTimes times_;
};

}  // namespace hilcam
