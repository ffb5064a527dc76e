#pragma once
// Position, attitude and motion of a thing.

#include "render/vocabulary/time.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// World: ICRF axes, metres, the origin that the scenario chooses. The attitude turns body axes into world
// axes.
struct Pose {
    Vec3d position_world_m;
    Quat world_from_body;
};

// A pose at an instant with its rates: velocity in the world [m/s], angular rate in body axes [rad/s].
struct Motion {
    TimeTai time;
    Pose pose;
    Vec3d velocity_world_m_s;
    Vec3d rate_body_rad_s;
};

// Returns the pose at another instant if velocity and body rate stay constant. Exact for such motion, for any
// time difference. Loop-safe.
Pose propagate(const Motion& motion, TimeTai time);
// Interpolates between two motions with a.time < b.time: cubic Hermite in position (by both velocities),
// slerp in attitude. `time` is clamped to [a.time, b.time]. Loop-safe.
Pose interpolate(const Motion& a, const Motion& b, TimeTai time);
// Returns the attitude with +z along `forward` and +y as near to -up as possible (camera axes: +x right, +y
// down, +z boresight). Throws InputError if the two are parallel or zero.
Quat look_along(Vec3d forward, Vec3d up);

}  // namespace hilcam
