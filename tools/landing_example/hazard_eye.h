#pragma once
// Finds ground without hazards in a picture from above, by light alone. With a low Sun light is slope: ground that leans
// towards or away from the Sun by d has sin(e + d) / sin(e) of flat ground's light at the elevation e, so that bounds on the light
// bound the slope along the Sun's direction; stones are shadows and bright faces. The place is the one with the widest
// clear circle, less what it is aside.
//
// Not seen: slopes across the Sun's direction, stones below two pixels, holes that are as bright as flat ground.

#include <opencv2/core.hpp>
#include <optional>

namespace flight {

struct HazardEyeOptions {
    double lander_radius_m = 1.5;
    double clear_m = 3;                           // a wider clear circle about the lander is no better
    double aside_cost = 0.05;                     // metres of clearance that a metre aside must bring
    double least_light = 0.55, most_light = 1.6;  // of the ground's mean, over the lander's own width
    double shadow_light = 0.35;                   // of single pixels
};

struct Site {
    cv::Vec2d at_px;
    double clear_m = 0;  // from the place to the nearest hazard
};

// frame: one channel of 16 bits with its offset taken off. pixel_m: width of a pixel on the ground; reach_px: how far from `about_px` a
// place may be. None: nothing within reach has room for the lander.
std::optional<Site> find_site(const cv::Mat& frame, double pixel_m, const cv::Vec2d& about_px,
                              double reach_px, const HazardEyeOptions& options);

}  // namespace flight
