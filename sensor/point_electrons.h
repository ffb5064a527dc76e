#pragma once
// Returns how many photo-electrons a point of light makes in one exposure, all of its image together, as
// FocalPlane draws it: mean over where it falls in a pixel and in a colour filter array's pattern. Not in it:
// what falls outside the frame, saturation, and what glare spreads evenly.

#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/spectrum.h"
#include "sensor/camera_model.h"
#include "sensor/optics.h"

namespace hilcam {

class PointElectrons {
  public:
    PointElectrons(const CameraModel& camera, const SpectralGrid& grid);

    // detector_px: its place in the window. irradiance: at the aperture, per bin. Any thread.
    double of(const Spectrum& irradiance_w_m2_um, Vec2d detector_px, double exposure_s) const;

  private:
    RelativeIllumination lens_;
    Spectrum per_irradiance_;  // e- s^-1 per W m^-2 um^-1, on the axis
    int bins_;
};

}  // namespace hilcam
