#pragma once
// MTF_sys of equation (2): everything between the scene and a pixel's charge that affects contrast.
//
// It includes optics (optics_otf.h), light-sensitive area, charge diffusion, crosstalk (only without colour
// filters; with them, crosstalk mixes colours and is not a filter on one image), steady jitter, and veiling
// glare. For a line camera it also includes the motion along the track: the charge follows the picture in
// steps of 1 / phases of a pixel, and drifts by stages x mismatch (Fiete, Modeling the Imaging Chain of
// Digital Cameras, SPIE, 2010, ch. 7: a sinc each).

#include <complex>

#include "sensor/camera_model.h"
#include "sensor/optics_otf.h"
#include "sensor/stray/spider.h"

namespace hilcam {

class SystemMtf {
  public:
    SystemMtf(const CameraModel& camera, OpticsOtf optics, SpiderSpikes spikes = {});

    // u, v: frequencies [cycles/px of the detector]. Even glare leaves 1 - glare everywhere but at
    // (0, 0).
    std::complex<double> at(double u, double v) const;
    // Returns the transfer function for the image of a point, without evenly spread glare and without a
    // spider's spikes, which are drawn separately: 1 at (0, 0).
    std::complex<double> of_point(double u, double v) const;

    // Returns how steeply the lens's modulation falls at frequency 0 [px], which determines the far wings of
    // its images.
    double wing_slope_px() const;
    const SpiderSpikes& spikes() const { return spikes_; }

  private:
    double behind_lens(double u, double v) const;
    double glare_factor(double u, double v) const;

    OpticsOtf optics_;
    SpiderSpikes spikes_;
    double aperture_x_px_, aperture_y_px_;
    double diffusion_px_, jitter_x_px_, jitter_y_px_;
    double crosstalk_;
    double glare_, glare_radius_px_;
    double step_px_ = 0, drift_px_ = 0;  // step and drift of a line camera along the track
};

}  // namespace hilcam
