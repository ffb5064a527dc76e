#pragma once
// The sensor: a radiance image goes in, digital numbers come out. Equation (2) of Peng et al. 2011,
//     DN = { IFT[ FT(S(L)) MTF_sys ] + noise } G,
// in two halves. expose() computes the mean charge of every pixel: light (focal_plane.h: S, MTF_sys, points),
// and each pixel's gain and dark current (fixed_pattern.h). digitise() adds noise (noise.h) and cosmic rays
// (cosmic_rays.h), moves the charge (ccd.h) and applies the electronics (read_out.h).

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

// Times of the last frame.
struct SensorTimes {
    double collapse_ms = 0;  // S: radiance to electrons
    double convolve_ms = 0;  // FFT pair and MTF
    double points_ms = 0;    // crop, dark current, point sources
    double digitise_ms = 0;  // noise, gain, ADC
};

class SensorChain {
  public:
    // Plans the FFT and draws the fixed patterns. pictures: contents of the camera's map files. Throws
    // InputError when a map has another size than the sensor. Owner thread.
    SensorChain(const CameraModel& camera, const SpectralGrid& grid, const SensorSampling& sampling,
                const DetectorPictures& pictures = {});
    ~SensorChain();

    // Computes the mean charge after one exposure [e-], including dark current; finite and not negative.
    // mean_e: as large as the read-out array. beside: light from outside the picture (outside_light.h). Loop,
    // one thread at a time.
    void expose(const RadianceImage& radiance, std::span<const PointSource> points, const Exposure& exposure,
                ElectronImage& mean_e, std::span<const SideLight> beside = {});
    // Adds noise and converts to digital numbers. frame: has the frame_size() for the exposure's binning.
    // Loop, one thread at a time.
    void digitise(const ElectronImage& mean_e, const Exposure& exposure, RandomKey key, DnImage& frame);

    const SensorTimes& times() const { return times_; }
    // Returns the modulus of MTF_sys without motion: everything from the lens to the converter that affects
    // contrast, at a frequency [cycles/px of the detector].
    double mtf(double u, double v) const;
    // Returns the MTF along the rows at the Nyquist frequency (0.5 cycles/px).
    double mtf_at_nyquist() const { return mtf(0.5, 0); }
    // Returns the radius of the compact kernel that replaces the FFT pair [px of the radiance image]; 0: the
    // FFT pair is used.
    int kernel_radius() const;
    // Returns the time of one bare FFT pair of the frame's size [ms], for `hilcam bench`.
    double fft_pair_ms();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
    SensorTimes times_;
};

}  // namespace hilcam
