#pragma once
// A body of the scene as one frame has it.

#include <array>
#include <cstddef>

#include "render/sky/bodies.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// A body this small is drawn as points, as an object is (plan.h): a grid of rays would meet too much of it or too little, and
// otherwise from frame to frame. Those with air are not, nor is the Earth by its model.
inline constexpr double kBodyPoints_px = 8.0;

// A body that shines on the objects: the cone that holds it.
struct PlanetshineSource {
    Vec3d world_dir;          // from the objects
    float cone_sine_squared;  // square of the sine of its half angle; 1 inside it
    float one_minus_cosine;   // 1 - cosine of its half angle, with all its digits where it is small
    Spectrum max_over_sun;    // greatest value of its radiance, per unit of solar irradiance [sr^-1]
};

// A body for one frame. Body axes: its own; "from" the body's centre.
struct PlacedBody {
    BodyId id{};
    Vec3d world_dir;         // from the camera to its centre, as seen
    double distance_m = 0;   // distance of the centre from the camera
    double cone_cosine = 1;  // cosine of the cone that holds it and its air; half a space inside it
    double disk_cosine = 1;  // cosine of the body without air
    Vec3d camera_m;          // the camera in body axes
    Vec3d sun_dir;           // in body axes
    Mat3d fixed_from_world;
    Figure figure{};
    Spectrum irradiance_w_m2_um;  // irradiance by the Sun at the body
    double sun_radius_rad = 0;    // the Sun's radius, seen from the body
    // Another body's light on it (planetshine), the strongest first.
    struct Shine {
        Vec3d dir;  // to that body, in this one's axes
        Spectrum irradiance_w_m2_um;
    };
    std::array<Shine, 2> shine{};
    std::size_t shine_count = 0;
    // Factors on its look that give the whole of it the light of its magnitude (disk_light.h).
    float globe_factor = 1, ring_factor = 1;
    bool may_be_eclipsed = false;  // another body can stand between it and the Sun
    bool in_points = false;        // a disk whose light comes by points: rays of the camera find it dark
};

}  // namespace hilcam
