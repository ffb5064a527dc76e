#pragma once
// This reads what the label of a map says of its coordinates and heights, as far as GDAL does not hand it on: the kind of its
// latitudes, the direction of its longitudes, its bounds in degrees, the unit of its values.
//
// PDS3: Planetary Data System Standards Reference 3.8 (2009), appendix A, and Planetary Science Data Dictionary (IMAGE_MAP_PROJECTION). ISIS:
// the group Mapping of a cube. PDS4: the dictionary `cart` (Cartography). What is not read is left out; nothing throws.

#include <optional>
#include <string>
#include <string_view>

#include "io/maps/longitude_latitude.h"

namespace hilcam {

struct MapLabel {
    enum class Format { kNone, kPds3, kIsis3, kPds4 } format = Format::kNone;
    // Latitudes are angles to the equator at the body's centre, or those of the ellipsoid's normal.
    std::optional<bool> planetocentric;
    std::optional<bool> longitudes_west;         // its numbers of longitude count to the west
    std::string latitudes_by, longitudes_by;     // the keywords that said so
    std::optional<double> center_longitude_deg;  // number of the label
    bool oblique = false;                        // its projection is an oblique cylinder
    std::optional<MapBounds> bounds;             // longitudes to the east
    std::string unit;                            // unit of the values, as it stands there
};

// text: of a label, or empty.
MapLabel read_map_label(const std::string& text);

// Returns how many metres a unit of length is; none: it is no such word.
std::optional<double> metres_of_unit(std::string_view unit);

}  // namespace hilcam
