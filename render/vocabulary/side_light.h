#pragma once
// Light of the Sun or a body that reaches the aperture from beside the picture, from one direction. A body is
// many of them, each a part of its lit face.

#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

struct SideLight {
    Vec3f camera_dir;  // unit, camera axes; z < 0 comes from behind
    // At the place of the aperture, on a plane that faces the light [W m^-2 um^-1], per bin.
    Spectrum irradiance_w_m2_um;
};

// No instant has more of them: as find_side_light.h samples the Sun and the bodies.
inline constexpr std::size_t kMaxSideLights = 24 + 256 * 24;

}  // namespace hilcam
