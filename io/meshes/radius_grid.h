#pragma once
// Shapes of small bodies as radii by latitude and longitude, as the Small Bodies Node of PDS has those of Thomas (latitude, longitude,
// radius: EAR-A-5-DDR-SHAPE-MODELS), Stooke (longitude, latitude, radius: EAR-A-5-DDR-STOOKE-SHAPE-MODELS) and of laser
// altimeters (NEAR-A-5-COLLECTED-MODELS). Angles are planetocentric.
//
// The column that goes beyond 90 degrees is the longitude. Rows may come in any order, and have 0 and 360 degrees both; further columns are
// passed over. Radii at a pole become one, their mean; where there is none, the mean of the ring beside it stands for it.

#include <string>
#include <string_view>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

// The direction in which longitudes grow. Stooke's tables have west, those of laser altimeters east; none says so itself.
enum class Longitudes { kUnsaid, kEast, kWest };

struct RadiusRow {
    double first_deg = 0, second_deg = 0;  // in the file's order
    double radius = 0;
    int line = 0;
};

// Returns the surface, unsaid longitudes taken as east. Throws InputError that begins with `name` for a table that does not go round the
// body or lacks a radius.
Mesh mesh_of_radii(const std::vector<RadiusRow>& rows, Longitudes longitudes, const std::string& name);

// Returns what a PDS label says: by POSITIVE_LONGITUDE_DIRECTION, or in its words ("west longitude"), where these name one direction alone.
Longitudes longitudes_of_label(std::string_view label);

}  // namespace hilcam
