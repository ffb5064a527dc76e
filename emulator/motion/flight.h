#pragma once
// A circle around a point with the camera looking at it: for senders and benchmarks.

#include "render/vocabulary/pose.h"

namespace hilcam {

struct CircleFlight {
    Vec3d center_m;
    Vec3d start_m{0, -40, 0};  // where the circle begins
    Vec3d axis{0, 0, 1};       // the circle's plane is perpendicular to it and holds the start
    double period_s = 60;
    Vec3d up{0, 0, 1};

    // The motion after `seconds`, with the exact velocity and body rate. Throws InputError when start, axis
    // and up do not define a circle and a roll.
    Motion at(double seconds, TimeTai time) const;
};

}  // namespace hilcam
