#pragma once
// Counts of the rays that a picture took, by purpose.

#include <cstdint>

namespace hilcam {

struct RayCounts {
    std::uint64_t primary_rays = 0;        // from the camera
    std::uint64_t shadow_rays = 0;         // to the Sun, from surfaces that the camera sees
    std::uint64_t bounce_shadow_rays = 0;  // to the Sun, from surfaces behind a bounce
    std::uint64_t lamp_rays = 0;           // to lamps, the Earth, the Moon, the planets
    std::uint64_t secondary_rays = 0;      // the rays that continue paths

    RayCounts& operator+=(const RayCounts& other) {
        primary_rays += other.primary_rays;
        shadow_rays += other.shadow_rays, bounce_shadow_rays += other.bounce_shadow_rays;
        lamp_rays += other.lamp_rays, secondary_rays += other.secondary_rays;
        return *this;
    }
};

}  // namespace hilcam
