#include "tools/flight_software_example/pointing.h"

#include <algorithm>

namespace flight {

cv::Vec3d PointingLaw::acceleration_rad_s2(const std::optional<cv::Vec2d>& target_px, double exposure_mid_s) {
    if (!target_px) {
        error_rad_.reset();
        return {};
    }
    const cv::Vec2d off_px = *target_px - camera_.boresight_px;
    const cv::Vec2d error_rad = {-off_px[1] / camera_.focal_px, off_px[0] / camera_.focal_px};
    cv::Vec2d rate_rad_s;  // zero until there are two frames
    if (error_rad_ && exposure_mid_s > error_at_s_)
        rate_rad_s = (error_rad - *error_rad_) / (exposure_mid_s - error_at_s_);
    error_rad_ = error_rad;
    error_at_s_ = exposure_mid_s;
    const double w = gains_.natural_frequency_rad_s;
    const cv::Vec2d wanted = w * w * error_rad + 2 * gains_.damping_ratio * w * rate_rad_s;
    const auto limited = [&](double a) { return std::clamp(a, -gains_.most_rad_s2, gains_.most_rad_s2); };
    return {limited(wanted[0]), limited(wanted[1]), 0};
}

}  // namespace flight
