#pragma once
// The noise of a camera's pixels as a few plain numbers, for those who make its radiance images
// (render/vocabulary/pixel_noise.h): what an error of rendering has to be small against.
//
// A pixel of the detector on the axis (sensor_noise.h). Under a colour filter array the electrons are those
// of the most sensitive filter of each bin: more samples than needed, never fewer.
//
// Pixels that are binned are averaged: their light and its noise together, the reading's noise once if it is
// their charge that is binned.

#include "render/vocabulary/pixel_noise.h"
#include "sensor/camera_model.h"
#include "sensor/exposure.h"

namespace hilcam {

class ExpectedNoise {
  public:
    ExpectedNoise(const CameraModel& camera, const SpectralGrid& grid, const SensorSampling& sampling);

    // Returns the noise of one pixel of the radiance image. Loop.
    PixelNoise of(const Exposure& exposure) const;

  private:
    CameraModel camera_;
    double oversampling_;
    Spectrum electrons_per_s_;  // per unit of radiance
};

}  // namespace hilcam
