#pragma once
// What a dynamics simulator does on a bench: moves the vehicle. Its place runs along a rail, its attitude is
// that of a rigid body with three equal moments of inertia and ideal actuators.
//
// World and body axes as hilcam has them: the body is the camera's, +x right, +y down in the picture, +z
// along the boresight. Not modelled: gyroscopic coupling (none between equal moments), actuators' errors.

#include <opencv2/core.hpp>
#include <opencv2/core/quaternion.hpp>

namespace flight {

// From one place to another with minimum jerk, at rest at both ends: s = 10 x^3 - 15 x^4 + 6 x^5 (Flash and
// Hogan 1985, J. Neuroscience 5(7), 1688). It stays at the ends before and after.
struct Rail {
    cv::Vec3d from_m, to_m;
    double duration_s = 100;

    cv::Vec3d position_m(double t_s) const;
    cv::Vec3d velocity_m_s(double t_s) const;
};

class Attitude {
  public:
    explicit Attitude(const cv::Quatd& world_from_body) : world_from_body_(world_from_body) {}

    // +z along `direction`, +y away from `up`.
    static Attitude looking(const cv::Vec3d& direction, const cv::Vec3d& up);
    // Turned by a rotation vector in body axes, at once.
    void offset(const cv::Vec3d& rotation_rad);
    // Time goes by under an acceleration in body axes. The rotation's axis is taken as fixed meanwhile, which
    // rates of a milliradian a second and steps of a tenth of one allow (error: the product of both turns).
    void turn(const cv::Vec3d& acceleration_rad_s2, double seconds);

    const cv::Quatd& world_from_body() const { return world_from_body_; }
    const cv::Vec3d& rate_rad_s() const { return rate_rad_s_; }

  private:
    cv::Quatd world_from_body_;
    cv::Vec3d rate_rad_s_;
};

}  // namespace flight
