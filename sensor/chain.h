#pragma once
// The sensor: radiance image in, digital numbers out. Equation (2) of Peng et al. 2011,
//     DN = { IFT[ FT(S(L)) MTF_sys ] + noise } G,
// in two halves. expose(): light, up to the mean charge of every pixel (focal_plane.h: S, MTF_sys, points;
// fixed_pattern.h: gain and dark current of each pixel). digitise(): what chance (noise.h), the charge's way
// out (ccd.h, cosmic_rays.h) and the electronics (read_out.h) make of it.

#include <memory>
#include <span>

#include "render/vocabulary/point_source.h"
#include "render/vocabulary/radiance_image.h"
#include "render/vocabulary/random.h"
#include "render/vocabulary/side_light.h"
#include "sensor/camera_model.h"
#include "sensor/exposure.h"
#include "sensor/fixed_pattern.h"

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
    // Plans the FFT, draws the fixed patterns. `pictures`: what the camera's map files hold. InputError when
    // a picture has another size than the sensor. Owner thread.
    SensorChain(const CameraModel& camera, const SpectralGrid& grid, const SensorSampling& sampling,
                const DetectorPictures& pictures = {});
    ~SensorChain();

    // Mean charge after one exposure [e-], dark current included; finite and not negative. mean_e has the
    // size of the read-out array. beside: light from beside the picture (outside_light.h). Loop, one thread at a
    // time.
    void expose(const RadianceImage& radiance, std::span<const PointSource> points, const Exposure& exposure,
                ElectronImage& mean_e, std::span<const SideLight> beside = {});
    // Adds noise and converts; `frame` has the frame_size() of the
    // exposure's binning. Loop, one thread at a time.
    void digitise(const ElectronImage& mean_e, const Exposure& exposure, RandomKey key, DnImage& frame);

    const SensorTimes& times() const { return times_; }
    // Modulus of MTF_sys as configured: everything from the lens to the converter that acts on contrast, at a
    // frequency [cycles/px of the detector], motion apart.
    double mtf(double u, double v) const;
    // Along the rows at the Nyquist frequency (0.5 cycles/px).
    double mtf_at_nyquist() const { return mtf(0.5, 0); }
    // Radius of the compact kernel in place of the FFT pair [px of the radiance image]; 0: the FFT pair.
    int kernel_radius() const;
    // Time of one bare FFT pair of the frame's size [ms]; for `hilcam bench`.
    double fft_pair_ms();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
    SensorTimes times_;
};

}  // namespace hilcam
