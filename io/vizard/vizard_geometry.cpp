#include "io/vizard/vizard_geometry.h"

#include <algorithm>
#include <cmath>

namespace hilcam {

Quat from_mrp(Vec3d sigma) {
    const double s2 = dot(sigma, sigma);
    const double scale = 1 / (1 + s2);
    return normalized(Quat{(1 - s2) * scale, 2 * sigma.x * scale, 2 * sigma.y * scale, 2 * sigma.z * scale});
}

Quat from_dcm(const Mat3d& dcm_yx) { return to_quat(transposed(dcm_yx)); }

double rotation_error(const Mat3d& m) {
    const Mat3d product = m * transposed(m);
    const double off = std::max({std::abs(product.x.y), std::abs(product.x.z), std::abs(product.y.z)});
    const double on =
        std::max({std::abs(product.x.x - 1), std::abs(product.y.y - 1), std::abs(product.z.z - 1)});
    const double mirrored = dot(cross(m.x, m.y), m.z) > 0 ? 0 : 2;
    return std::max({off, on, mirrored});
}

Quat body_from_camera(Vec3d sigma_ub) {
    // u_from_c is the conjugate of from_mrp(sigma_UC) = (1, 1, 1, -1) / 2: x_C is y_U, y_C is -z_U, z_C is
    // -x_U.
    constexpr Quat kUFromC{0.5, -0.5, -0.5, 0.5};
    return normalized(from_mrp(sigma_ub) * kUFromC);
}

double angle_between(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

double angle_between(const Mat3d& a, const Mat3d& b) {
    const Quat q = to_quat(a * transposed(b));
    return 2 * std::atan2(length(Vec3d{q.x, q.y, q.z}), std::abs(q.w));
}

}  // namespace hilcam
