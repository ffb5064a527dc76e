#pragma once
// What tests of motion share.

#include <string>

#include "render/vocabulary/pose.h"

namespace hilcam {

inline const std::string kIss =
    "ISS (ZARYA)\n"
    "1 25544U 98067A   14020.93268519  .00009878  00000-0  18200-3 0  5082\n"
    "2 25544  51.6498 109.4756 0003572  55.9686 274.8005 15.49815350868473\n";

// The turn from a to b, as a rotation vector; small ones.
inline Vec3d turn_between(Quat a, Quat b) {
    const Quat q = conjugate(a) * b;
    return (q.w < 0 ? -2.0 : 2.0) * Vec3d{q.x, q.y, q.z};
}

}  // namespace hilcam
