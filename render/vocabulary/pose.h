#pragma once
// A pose says where a thing is, how it is turned and how it moves.

#include "render/vocabulary/time.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// World: ICRF axes, metres, origin as the scenario says. Attitude turns body axes into world axes.
struct Pose {
    Vec3d position_world_m;
    Quat world_from_body;
};

// A pose at an instant and its rates: velocity in the world [m/s], angular rate in body axes [rad/s].
struct Motion {
    TimeTai time;
    Pose pose;
    Vec3d velocity_world_m_s;
    Vec3d rate_body_rad_s;
};

// The pose at another instant, velocity and body rate held constant. Exact for such motion; any dt.
// Loop-safe.
Pose propagate(const Motion& motion, TimeTai time);
// Interpolates between two motions a.time < b.time: cubic Hermite in position (from both velocities), slerp
// in attitude. time is clamped to [a.time, b.time]. Loop-safe.
Pose interpolate(const Motion& a, const Motion& b, TimeTai time);
// The attitude whose +z axis points along `forward` and whose +y axis lies as near to -up as it can (camera
// axes: +x right, +y down, +z boresight). Throws InputError when the two are parallel or zero.
Quat look_along(Vec3d forward, Vec3d up);

}  // namespace hilcam
