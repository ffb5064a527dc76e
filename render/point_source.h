#pragma once
// A thing smaller than a pixel: its light reaches the aperture from one direction.

#include "render/spectrum.h"
#include "render/vec.h"

namespace hilcam {

struct PointSource {
    // In the sensor frame: the centre of pixel (0, 0) is (0.5, 0.5), the guard band is not counted; may lie
    // outside.
    Vec2f position_px;
    // At the aperture [W m^-2 um^-1], per bin.
    Spectrum irradiance_w_m2_um;
};

}  // namespace hilcam
