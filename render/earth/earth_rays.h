#pragma once
// Finds where camera rays meet a body, sixteen at a time: the same as intersect_ellipsoid and
// ellipsoid_normal (bodies.h) for one ray, in a form that compilers vectorise. Double precision.

#include <array>

#include "render/sky/bodies.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

struct EarthRays {
    static constexpr std::size_t kCount = 16;
    static constexpr float kMiss = -2;
    using Floats = std::array<float, kCount>;

    // camera_m, sun_dir: in the body's axes, from its centre [m]. Rays have directions corner + x right + y
    // down, any length.
    EarthRays(const Figure& figure, Vec3d camera_m, Vec3d sun_dir, Vec3d corner_dir, Vec3d right_dir,
              Vec3d down_dir);

    // Finds the cosine of the Sun's zenith angle where the rays at (x, y) meet the ground, or kMiss. Loop,
    // any thread.
    void sun_cosines(const Floats& x, const Floats& y, Floats& cosine) const;

    // All with z stretched so that the ellipsoid is a sphere.
    double radius_m, stretch;
    Vec3d origin_m, corner, right, down;
    Vec3d sun;  // its dot product with a stretched point is that with the ellipsoid's normal
};

}  // namespace hilcam
