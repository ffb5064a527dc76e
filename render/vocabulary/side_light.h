#pragma once
// Light from one direction outside the picture, from the Sun or a body. A body is many of these, one for each
// part of its lit face.

#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

struct SideLight {
    Vec3f camera_dir;  // unit, camera axes; z < 0 comes from behind
    // Irradiance at the aperture, on a plane that faces the light [W m^-2 um^-1], per bin.
    Spectrum irradiance_w_m2_um;
};

// The most that one instant can have, from the way find_side_light.h samples the Sun and the bodies.
inline constexpr std::size_t kMaxSideLights = 24 + 256 * 24;

}  // namespace hilcam
