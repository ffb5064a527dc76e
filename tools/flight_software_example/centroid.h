#pragma once
// The target's centre of light in a frame.
//
// Sky level and noise come from the picture's border; what is brighter than the level by some of its noise is
// joined with what is near, the group with the most light is the target, and its centroid is weighted by the
// light above the level. The group reaches a little past its bright pixels, so that the blurred edge and dim
// parts count and no pixel flickers in and out at the threshold. Not modelled: a target that fills the
// border, a body's limb behind it.
//
// Pixels as OpenCV has them: the centre of the upper left one is (0, 0), +x right, +y down.

#include <opencv2/core.hpp>
#include <optional>

namespace flight {

struct CentroidOptions {
    double threshold_sigma = 6;  // of 150 000 pixels of noise none exceeds it
    int join_px = 6;             // parts that are nearer are one group; also how far it reaches past them
    int least_px = 4;            // bright ones of a target: fewer are hot pixels, stars, particles
    int border_px = 8;
};

struct Centroid {
    cv::Vec2d at_px;
    double light_dn = 0;  // above the sky, of the whole group
    int bright_px = 0;
};

// frame: one channel of 16 bits. None: nothing is bright and large enough.
std::optional<Centroid> find_target(const cv::Mat& frame, const CentroidOptions& options);

}  // namespace flight
