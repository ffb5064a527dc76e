#pragma once
// The craters and boulders of a scenario's ground about a place.

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

// A list of a thousand square kilometres' smallest craters would fill a disk.
inline constexpr double kMaxListed = 2e6;
// Throws InputError for more; keys: what would make them fewer.
void require_few(double count, const char* what, const char* keys);

// Finds those above a diameter with their middles within a distance of a place. Throws InputError where the ground has no
// such things, or there would be too many; keys: what would make them fewer.
std::vector<GroundThing> find_things(GroundThings kind, const GlobeConfig& globe, const MappedBody& body,
                                     Vec3d middle, double within_m, double smallest_m,
                                     const char* keys = "--within-m, --smallest-m");

}  // namespace hilcam
