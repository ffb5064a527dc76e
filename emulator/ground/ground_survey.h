#pragma once
// Lists what is on the ground around a place: seeded craters and boulders, or heights with slopes and steps.
// It serves to judge whether a navigation or landing program has found them.

#include <string>

#include "emulator/ground/globe_config.h"
#include "emulator/ground/ground_heights.h"
#include "emulator/ground/ground_things.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// Limits beyond which a lander cannot stand.
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
    // Greatest distance of craters' and boulders' centres; half the edge of the square of heights.
    double within_m = 100;
    double smallest_m = 0;  // smallest diameter; 0: all
    double spacing_m = 1;   // distance between heights
    HazardLimits limits;
};

inline constexpr const char* kPlaceColumns = "longitude_deg,latitude_deg,east_m,north_m,";
const char* things_columns(GroundThings kind);

// Returns comma-separated values under a line of column names. Positions are east and north of the middle,
// along the ground [m].
//   Craters: diameter, and wear (0 fresh to CraterProfile::kMaxWorn).
//   Boulders: greatest width, height above the ground.
//   Heights: height above the ellipsoid, slope of the plane through the neighbours, and the largest
//       deviation of one of these from that plane.
//   Hazards: the same, then 1 where a limit is exceeded, else 0.
// Throws InputError where the ground has no such things, or too many.
std::string survey_ground(const GlobeConfig& globe, const MappedBody& body, const GroundSurvey& survey);

}  // namespace hilcam
