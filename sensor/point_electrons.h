#pragma once
// Computes how many photo-electrons a point of light makes in one exposure, over its whole image as
// FocalPlane draws it: the mean over its position within a pixel and in a colour filter array's pattern. Not
// included: losses outside the frame, saturation, and light that glare spreads evenly.

#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/spectrum.h"
#include "sensor/camera_model.h"
#include "sensor/optics.h"

namespace hilcam {

class PointElectrons {
  public:
    PointElectrons(const CameraModel& camera, const SpectralGrid& grid);

    // detector_px: place of the point in the window. irradiance_w_m2_um: at the aperture, in each bin. Any
    // thread.
    double of(const Spectrum& irradiance_w_m2_um, Vec2d detector_px, double exposure_s) const;

  private:
    RelativeIllumination lens_;
    Spectrum per_irradiance_;  // e- s^-1 per W m^-2 um^-1, on the axis
    int bins_;
};

}  // namespace hilcam
