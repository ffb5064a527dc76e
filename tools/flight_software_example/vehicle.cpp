#include "tools/flight_software_example/vehicle.h"

#include <algorithm>

namespace flight {

cv::Vec3d Rail::position_m(double t_s) const {
    const double x = std::clamp(t_s / duration_s, 0.0, 1.0);
    const double s = x * x * x * (10 + x * (-15 + x * 6));
    return from_m + s * (to_m - from_m);
}

cv::Vec3d Rail::velocity_m_s(double t_s) const {
    const double x = std::clamp(t_s / duration_s, 0.0, 1.0);
    const double s_dot = 30 * x * x * (1 - x) * (1 - x) / duration_s;
    return s_dot * (to_m - from_m);
}

Attitude Attitude::looking(const cv::Vec3d& direction, const cv::Vec3d& up) {
    const cv::Vec3d z = cv::normalize(direction);
    const cv::Vec3d y = cv::normalize(up.dot(z) * z - up);
    const cv::Vec3d x = y.cross(z);
    return Attitude(
        cv::Quatd::createFromRotMat(cv::Matx33d(x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2])));
}

void Attitude::offset(const cv::Vec3d& rotation_rad) {
    // Not Quatd::createFromRvec(): it takes less than a microradian for none.
    const cv::Vec3d half = 0.5 * rotation_rad;
    world_from_body_ = (world_from_body_ * cv::Quatd(0, half[0], half[1], half[2]).exp()).normalize();
}

void Attitude::turn(const cv::Vec3d& acceleration_rad_s2, double seconds) {
    offset(seconds * rate_rad_s_ + 0.5 * seconds * seconds * acceleration_rad_s2);
    rate_rad_s_ += seconds * acceleration_rad_s2;
}

}  // namespace flight
