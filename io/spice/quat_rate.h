#pragma once
// Angular rate from a quaternion and its derivative.

#include "render/vocabulary/vec.h"

namespace hilcam {

// Returns the rate in the axes that the quaternion rotates into, for q and dq/dt of any length but 0: omega =
// 2 dq/dt q*. The component of dq/dt along q only changes the length.
inline Vec3d turn_rate(Quat q, Quat q_rate) {
    const double size2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    const Quat w = q_rate * conjugate(q);
    return Vec3d{w.x, w.y, w.z} * (2 / size2);
}

}  // namespace hilcam
