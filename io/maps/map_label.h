#pragma once
// Reads from a map's label what GDAL does not pass on: the kind of its latitudes, the direction of its
// longitudes, its bounds in degrees, and the unit of its values.
//
// PDS3: Planetary Data System Standards Reference 3.8 (2009), appendix A, and Planetary Science Data
// Dictionary (IMAGE_MAP_PROJECTION). ISIS: the group Mapping of a cube. PDS4: the dictionary `cart`
// (Cartography). Unreadable statements are ignored; nothing throws.

#include <optional>
#include <string>
#include <string_view>

#include "io/maps/longitude_latitude.h"

namespace hilcam {

struct MapLabel {
    enum class Format { kNone, kPds3, kIsis3, kPds4 } format = Format::kNone;
    // True: latitudes are angles at the body's centre. False: angles of the ellipsoid's normal.
    std::optional<bool> planetocentric;
    std::optional<bool> longitudes_west;         // longitudes count to the west
    std::string latitudes_by, longitudes_by;     // the keywords that said so
    std::optional<double> center_longitude_deg;  // number in the label
    bool oblique = false;                        // the projection is an oblique cylinder
    std::optional<MapBounds> bounds;             // longitudes count to the east
    std::string unit;                            // unit of the values, as in the label
};

// text: of a label, or empty.
MapLabel read_map_label(const std::string& text);

// Returns the length of a unit in metres; nothing for an unknown word.
std::optional<double> metres_of_unit(std::string_view unit);

}  // namespace hilcam
