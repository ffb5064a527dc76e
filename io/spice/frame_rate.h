#pragma once
// The rate at which axes turn, from where they are a little before and after.

#include "render/vocabulary/vec.h"

namespace hilcam {

// Returns the rate in the reference's axes [rad/s]. The matrices take vectors from the axes into the reference's; span_s:
// from the one before to the one after.
inline Vec3d rate_of(const Mat3d& now, const Mat3d& before, const Mat3d& after, double span_s) {
    const Mat3d axes = transposed(now), from = transposed(before), to = transposed(after);
    Vec3d rate_rad_s{0, 0, 0};
    for (const Vec3d Mat3d::*axis : {&Mat3d::x, &Mat3d::y, &Mat3d::z})
        rate_rad_s = rate_rad_s + 0.5 / span_s * cross(axes.*axis, to.*axis - from.*axis);
    return rate_rad_s;
}

}  // namespace hilcam
