#pragma once
// Finds the craters and boulders of a scenario's ground around a place.

#include <string>
#include <vector>

#include "emulator/ground/globe_config.h"

namespace hilcam {

enum class GroundThings { kCraters, kBoulders };

struct GroundThing {
    Vec3d place;  // unit vector, body axes
    double diameter_m = 0;
    double figure =
        0;  // craters: wear, 0 fresh to CraterProfile::kMaxWorn; boulders: height above the ground [m]
};

// Largest number of things in a list. A list of the smallest craters on a thousand square kilometres would
// fill a disk.
inline constexpr double kMaxListed = 2e6;
// Throws InputError when there are more than kMaxListed. keys: options that would reduce the number, for the
// message.
void require_few(double count, const char* what, const char* keys);

// Finds craters or boulders larger than smallest_m [m, diameter] with centres nearer to `middle` than
// within_m. Throws InputError if the ground has none of them, or too many. keys: options that would reduce
// their number, for the message.
std::vector<GroundThing> find_things(GroundThings kind, const GlobeConfig& globe, const MappedBody& body,
                                     Vec3d middle, double within_m, double smallest_m,
                                     const char* keys = "--within-m, --smallest-m");

}  // namespace hilcam
