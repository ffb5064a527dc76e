#pragma once
// The heights and rays of a seeded crater at the places of a patch, compiled for several vector widths with
// the same bits. Any thread.

#include <array>

#include "render/ground/crater_profile.h"
#include "render/ground/cube_sphere.h"
#include "render/ground/ground_detail.h"

namespace hilcam {

// The rim's outline has waves with 2 to 5 periods around it.
inline constexpr std::size_t kCraterWaves = 4;

struct CraterShape {
    Vec3d place;       // unit vector
    AlongGround axes;  // at the place
    double radius_m = 1, depth_m = 1;
    double body_radius_m = 1;
    CraterProfile::Worn profile;
    std::array<double, kCraterWaves> wave_cos{}, wave_sin{};
    double bright = 0, ray_phase_rad = 0;
    int ray_count = 7;

    // The rays of the youngest craters extend farther than their heights [radii].
    static constexpr double kRayReach = 6;
    static double reach(double bright) { return bright > 0 ? kRayReach : CraterProfile::kReach; }
};

// Adds the crater to a patch's heights and its rays to the colours.
void add_crater(const CraterShape& crater, const GroundPatch& patch);

}  // namespace hilcam
