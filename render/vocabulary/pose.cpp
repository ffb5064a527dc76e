#include "render/vocabulary/pose.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"

namespace hilcam {

Pose propagate(const Motion& motion, TimeTai time) {
    const double dt_s = static_cast<double>(time - motion.time) * kSecondsPerNs;
    return {motion.pose.position_world_m + dt_s * motion.velocity_world_m_s,
            normalized(motion.pose.world_from_body * from_rotation_vector(dt_s * motion.rate_body_rad_s))};
}

Pose interpolate(const Motion& a, const Motion& b, TimeTai time) {
    HILCAM_DCHECK(a.time < b.time);
    const double span_s = static_cast<double>(b.time - a.time) * kSecondsPerNs;
    const double u = std::clamp(static_cast<double>(time - a.time) * kSecondsPerNs / span_s, 0.0, 1.0);
    // Cubic Hermite basis (de Boor, A Practical Guide to Splines, 1978).
    const double u2 = u * u;
    const double u3 = u2 * u;
    const Vec3d position = (2 * u3 - 3 * u2 + 1) * a.pose.position_world_m +
                           ((u3 - 2 * u2 + u) * span_s) * a.velocity_world_m_s +
                           (3 * u2 - 2 * u3) * b.pose.position_world_m +
                           ((u3 - u2) * span_s) * b.velocity_world_m_s;
    return {position, slerp(a.pose.world_from_body, b.pose.world_from_body, u)};
}

Quat look_along(Vec3d forward, Vec3d up) {
    const Vec3d right = cross(forward, up);
    // sin of the angle between them: below 1e-9 the roll about the boresight is lost in rounding.
    if (!is_finite(right) || !(length(right) > 1e-9 * length(forward) * length(up)))
        throw InputError("look_at and up must not be parallel or zero: the camera's roll would be undefined");
    const Vec3d z = normalized(forward);
    const Vec3d x = normalized(right);
    const Vec3d y = cross(z, x);
    return to_quat(transposed(Mat3d{x, y, z}));
}

}  // namespace hilcam
