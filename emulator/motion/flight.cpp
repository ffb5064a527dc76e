#include "emulator/motion/flight.h"

#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {

Motion CircleFlight::at(double seconds, TimeTai time) const {
    const Vec3d n = normalized(axis);
    const Vec3d from_center = start_m - center_m;
    const double along = dot(from_center, n);
    const Vec3d across = from_center - along * n;
    if (!is_finite(n) || !(length(across) > 0) || !(period_s != 0))
        throw InputError(
            "circle: the start must be off the axis through the centre, and the period must not be 0");
    const double rate_rad_s = 2 * kPi / period_s;
    const double angle = rate_rad_s * seconds;
    const Vec3d turned = std::cos(angle) * across + std::sin(angle) * cross(n, across);
    Motion motion;
    motion.time = time;
    motion.pose.position_world_m = center_m + along * n + turned;
    motion.velocity_world_m_s = rate_rad_s * cross(n, turned);
    // Everything turns about the axis, including the camera: attitude = rotation * attitude at the start.
    const Quat start = look_along(center_m - start_m, up);
    motion.pose.world_from_body = normalized(from_rotation_vector(angle * n) * start);
    motion.rate_body_rad_s = transposed(to_matrix(motion.pose.world_from_body)) * (rate_rad_s * n);
    return motion;
}

}  // namespace hilcam
