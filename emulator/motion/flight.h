#pragma once
// A circular flight around a point, with the camera looking at it: for senders and benchmarks.

#include "render/vocabulary/pose.h"

namespace hilcam {

struct CircleFlight {
    Vec3d center_m;
    Vec3d start_m{0, -40, 0};  // where the circle begins
    Vec3d axis{0, 0, 1};       // normal of the circle's plane, which contains the start
    double period_s = 60;
    Vec3d up{0, 0, 1};

    // Returns the motion after `seconds`, with the exact velocity and body rate. Throws InputError when
    // start, axis and up do not define a circle and a roll.
    Motion at(double seconds, TimeTai time) const;
};

}  // namespace hilcam
