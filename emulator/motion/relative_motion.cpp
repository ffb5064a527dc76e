#include "emulator/motion/relative_motion.h"

#include <cmath>

#include "render/vocabulary/check.h"

namespace hilcam {

StateVector drifted(const StateVector& initial, double n, double seconds) {
    const Vec3d& p = initial.position_m;
    const Vec3d& v = initial.velocity_m_s;
    const double angle = n * seconds, s = std::sin(angle), c = std::cos(angle);
    // x is along the orbit, y against the normal, z down.
    const double loop = 4 * v.x / n - 6 * p.z, drift_m_s = 6 * n * p.z - 3 * v.x;
    const double middle_z = 4 * p.z - 2 * v.x / n, swing_z = 2 * v.x / n - 3 * p.z;
    return {{loop * s - 2 * v.z / n * c + drift_m_s * seconds + p.x + 2 * v.z / n, p.y * c + v.y / n * s,
             swing_z * c + v.z / n * s + middle_z},
            {loop * n * c + 2 * v.z * s + drift_m_s, v.y * c - p.y * n * s, v.z * c - swing_z * n * s}};
}

double mean_motion_rad_s(const StateVector& state, double gravity_m3_s2) {
    const double r = length(state.position_m), v2 = dot(state.velocity_m_s, state.velocity_m_s);
    const double per_a = 2 / r - v2 / gravity_m3_s2;
    if (!(per_a > 0)) throw InputError("the orbit of the thing that is followed is not closed");
    return std::sqrt(gravity_m3_s2 * per_a) * per_a;
}

}  // namespace hilcam
