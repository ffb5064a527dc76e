#pragma once
// Shapes of small bodies as radii by latitude and longitude, as in the Small Bodies Node of PDS: Thomas's
// (latitude, longitude, radius: EAR-A-5-DDR-SHAPE-MODELS), Stooke's (longitude, latitude, radius:
// EAR-A-5-DDR-STOOKE-SHAPE-MODELS) and those of laser altimeters (NEAR-A-5-COLLECTED-MODELS). Angles are
// planetocentric.
//
// The column that exceeds 90 degrees is the longitude. Rows may come in any order and have both 0 and 360
// degrees; further columns are skipped. Several radii at a pole become their mean; a pole without one gets
// the mean of the next ring.

#include <string>
#include <string_view>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

// The direction in which longitudes grow: west in Stooke's tables, east in those of laser altimeters. The
// tables do not say.
enum class Longitudes { kUnsaid, kEast, kWest };

struct RadiusRow {
    double first_deg = 0, second_deg = 0;  // in the file's order
    double radius = 0;
    int line = 0;
};

// Returns the surface; unsaid longitudes are read as east. Throws InputError that begins with `name` for a
// table that does not go around the body or lacks a radius.
Mesh mesh_of_radii(const std::vector<RadiusRow>& rows, Longitudes longitudes, const std::string& name);

// Returns the direction in a PDS label: from POSITIVE_LONGITUDE_DIRECTION, or from its words ("west
// longitude") when they name only one direction.
Longitudes longitudes_of_label(std::string_view label);

}  // namespace hilcam
