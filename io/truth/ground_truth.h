#pragma once
// An interface to the craters and boulders that a frame shows. The implementation knows the ground
// (emulator/run/ground_footprint.h).

#include <optional>
#include <string>
#include <vector>

#include "render/frame/frame_truth.h"

namespace hilcam {

struct SeenGroundThing {
    double longitude_deg = 0, latitude_deg = 0;
    double diameter_m = 0;
    double figure = 0;  // craters: wear, from 0 (fresh) to 0.5; boulders: height above the ground [m]
    Vec2d place_px;     // centre in the frame
    double diameter_px = 0;
    double distance_m = 0;
    std::optional<bool> visible{};  // false: hidden by other ground; none: not tested
};
struct SeenGroundThings {
    std::vector<SeenGroundThing> craters, boulders;
    std::string left_out;  // why none are listed; empty: all are
};

class GroundTruth {
  public:
    virtual ~GroundTruth() = default;
    // Finds what a frame shows. Truth's thread; may allocate; does not throw.
    virtual SeenGroundThings find(const FrameTruth& truth) const = 0;
};

}  // namespace hilcam
