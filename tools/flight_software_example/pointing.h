#pragma once
// The pointing law: from where the target is in the picture to an angular acceleration. Proportional and
// derivative, and the picture is all it knows: no gyro, no star tracker, no knowledge of the trajectory.
//
// Small angles: e is the rotation vector in body axes that would bring the target to the boresight,
//     e = (-v / f, u / f, 0)      u, v: the target's place right of and below the boresight [px], f [px]
//     acceleration = w^2 e + 2 z w de/dt      limited; w: natural frequency, z: damping ratio
// With the vehicle a double integrator, a line of sight that turns steadily is followed without error, and
// one that accelerates by a with the error a / w^2.

#include <opencv2/core.hpp>
#include <optional>

namespace flight {

struct PointingGains {
    double natural_frequency_rad_s = 1.0;  // a frame every 0.2 s and 0.1 s of computing leave 40 deg of phase
    double damping_ratio = 0.9;
    double most_rad_s2 = 0.02;  // on each axis
};

// What the flight software knows of its camera.
struct CameraCalibration {
    double focal_px = 0;
    cv::Vec2d boresight_px;
};

class PointingLaw {
  public:
    PointingLaw(const CameraCalibration& camera, const PointingGains& gains)
        : camera_(camera), gains_(gains) {}

    const CameraCalibration& camera() const { return camera_; }
    // Where the target was at the middle of an exposure; none: it was not seen, and the vehicle coasts.
    cv::Vec3d acceleration_rad_s2(const std::optional<cv::Vec2d>& target_px, double exposure_mid_s);

  private:
    CameraCalibration camera_;
    PointingGains gains_;
    std::optional<cv::Vec2d> error_rad_;  // of the frame before: about x and y
    double error_at_s_ = 0;
};

}  // namespace flight
