#pragma once
// A body of the scene, as one frame has it.

#include <array>
#include <cstddef>

#include "render/sky/bodies.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// A body below this size is drawn as points, like an object (plan.h): a grid of rays would meet too much or
// too little of it, and differently in each frame. Bodies with air and the Earth's model are excluded.
inline constexpr double kBodyPoints_px = 8.0;

// A body that lights the objects: a cone around it.
struct PlanetshineSource {
    Vec3d world_dir;          // from the objects
    float cone_sine_squared;  // sin^2 of its half angle; 1 inside it
    float one_minus_cosine;   // 1 - cosine of its half angle, precise when small
    Spectrum max_over_sun;    // largest radiance per unit of solar irradiance [sr^-1]
};

// A body in one frame. Body axes are its own, with the origin at its centre.
struct PlacedBody {
    BodyId id{};
    Vec3d world_dir;         // from the camera to its centre, apparent
    double distance_m = 0;   // from the camera to the centre
    double cone_cosine = 1;  // cone around it and its air; a half-space inside it
    double seen_cosine = 1;  // cone of the directions in which it may be seen through bending air
    double disk_cosine = 1;  // body without air
    Vec3d camera_m;          // the camera in body axes
    Vec3d sun_dir;           // in body axes
    Mat3d fixed_from_world;
    Figure figure{};
    Spectrum irradiance_w_m2_um;  // by the Sun at the body
    double sun_radius_rad = 0;    // apparent radius of the Sun at the body
    // Light of other bodies on it (planetshine), the strongest first.
    struct Shine {
        Vec3d dir;  // to that body, in this one's axes
        Spectrum irradiance_w_m2_um;
    };
    std::array<Shine, 2> shine{};
    std::size_t shine_count = 0;
    // Factors on its look that give the whole body the light of its magnitude (disk_light.h).
    float globe_factor = 1, ring_factor = 1;
    bool may_be_eclipsed = false;  // another body may be between it and the Sun
    bool in_points = false;        // a disk that is drawn as points: camera rays find it dark
};

}  // namespace hilcam
