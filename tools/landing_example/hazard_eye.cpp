#include "tools/landing_example/hazard_eye.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace flight {
namespace {

// 255 where nothing is wrong, 0 at a hazard.
cv::Mat clear_ground(const cv::Mat& frame, double pixel_m, const HazardEyeOptions& o) {
    cv::Mat light, wide, mask;
    frame.convertTo(light, CV_32F);
    light /= std::max(1.0, cv::mean(light)[0]);
    const int width = std::max(1, static_cast<int>(std::lround(2 * o.lander_radius_m / pixel_m)));
    cv::blur(light, wide, {width, width});
    mask = (wide > o.least_light) & (wide < o.most_light) & (light > o.shadow_light) &
           (light < 1.5 * o.most_light);
    return mask;
}

}  // namespace

std::optional<Site> find_site(const cv::Mat& frame, double pixel_m, const cv::Vec2d& about_px,
                              double reach_px, const HazardEyeOptions& o) {
    cv::Mat mask = clear_ground(frame, pixel_m, o), clear_px;
    // What lies beside the picture is not known to be clear.
    cv::rectangle(mask, {0, 0, mask.cols, mask.rows}, 0, 1);
    cv::distanceTransform(mask, clear_px, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    std::optional<Site> best;
    double most = 0;
    for (int y = 0; y < mask.rows; ++y)
        for (int x = 0; x < mask.cols; ++x) {
            const double aside_px = std::hypot(x - about_px[0], y - about_px[1]);
            const double clear_m = pixel_m * static_cast<double>(clear_px.at<float>(y, x));
            if (aside_px > reach_px || clear_m < o.lander_radius_m) continue;
            const double worth =
                std::min(clear_m, o.lander_radius_m + o.clear_m) - o.aside_cost * pixel_m * aside_px;
            if (best && worth <= most) continue;
            most = worth;
            best = Site{{static_cast<double>(x), static_cast<double>(y)}, clear_m};
        }
    return best;
}

}  // namespace flight
