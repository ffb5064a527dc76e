#include "io/vizard/vizard_geometry.h"

#include <cmath>

namespace hilcam {

Quat body_from_camera(Vec3d sigma_ub) {
    // u_from_c is the conjugate of from_mrp(sigma_UC) = (1, 1, 1, -1) / 2: x_C is y_U, y_C is -z_U, z_C is
    // -x_U.
    constexpr Quat kUFromC{0.5, -0.5, -0.5, 0.5};
    return normalized(from_mrp(sigma_ub) * kUFromC);
}

double turn_between_rad(const Mat3d& a, const Mat3d& b) {
    const Quat q = to_quat(a * transposed(b));
    return 2 * std::atan2(length(Vec3d{q.x, q.y, q.z}), std::abs(q.w));
}

}  // namespace hilcam
