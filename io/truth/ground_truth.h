#pragma once
// The craters and boulders of the ground that a frame shows, as an interface: who knows the ground finds them
// (emulator/run/ground_footprint.h).

#include <optional>
#include <string>
#include <vector>

#include "render/frame/frame_truth.h"

namespace hilcam {

struct SeenGroundThing {
    double longitude_deg = 0, latitude_deg = 0;
    double diameter_m = 0;
    double figure = 0;  // craters: wear, 0 fresh to 0.5; boulders: height above the ground [m]
    Vec2d place_px;     // place of its middle in the frame
    double diameter_px = 0;
    double distance_m = 0;
    std::optional<bool> visible{};  // false: behind other ground; none: nobody has looked
};
struct SeenGroundThings {
    std::vector<SeenGroundThing> craters, boulders;
    std::string left_out;  // reason why none are listed; empty: all are
};

class GroundTruth {
  public:
    virtual ~GroundTruth() = default;
    // Finds what a frame shows. Truth's thread; allocates; throws nothing.
    virtual SeenGroundThings find(const FrameTruth& truth) const = 0;
};

}  // namespace hilcam
