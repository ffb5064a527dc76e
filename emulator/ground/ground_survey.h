#pragma once
// This tells as text what is on the ground about a place: the craters and boulders that were seeded, and heights with slopes and steps, for
// who judges whether a navigation or a landing program has found them.

#include <string>

#include "emulator/ground/globe_config.h"
#include "emulator/ground/ground_heights.h"
#include "emulator/ground/ground_things.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// The limits beyond which a lander cannot stand.
struct HazardLimits {
    double slope_rad = 10 * kDegree_rad;
    double step_m = 0.3;
    bool is_hazard(const GroundSlope& slope) const {
        return slope.slope_rad > slope_rad || slope.step_m > step_m;
    }
};

struct GroundSurvey {
    enum class What { kCraters, kBoulders, kHeights, kHazards } what = What::kCraters;
    Geodetic middle;
    double within_m =
        100;  // craters and boulders whose middles are so near; half the edge of the heights' square
    double smallest_m = 0;  // least diameter; 0: all
    double spacing_m = 1;   // distance of the heights
    HazardLimits limits;
};

inline constexpr const char* kPlaceColumns = "longitude_deg,latitude_deg,east_m,north_m,";
const char* things_columns(GroundThings kind);

// Returns comma-separated values with a line of names. Places are east and north of the middle, along the ground [m]. Craters:
// diameter, and wear (0 fresh to CraterProfile::kMaxWorn). Boulders: greatest width, height above the ground. Heights: over the
// ellipsoid, with the slope of the plane through the neighbours and the greatest difference of height to one of them after that
// plane; hazards have 1 behind these where one of the limits is exceeded, else 0. Throws InputError where the ground has no such things, or there would be too many of them.
std::string survey_ground(const GlobeConfig& globe, const MappedBody& body, const GroundSurvey& survey);

}  // namespace hilcam
