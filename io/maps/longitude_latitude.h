#pragma once
// Finds the posts of a map in longitude and latitude. Latitudes are planetographic (angle of the surface
// normal) or planetocentric (angle of the line from the body's centre).

#include <cmath>

#include "render/ground/ground_raster.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// The outer edges of the outermost posts.
struct MapBounds {
    double west_deg = -180, south_deg = -90, east_deg = 180, north_deg = 90;
};

// Sets the members of a shape that follow from the bounds; columns and rows are set already.
inline void set_bounds(const MapBounds& b, double radius_m, GroundRaster::Shape& shape) {
    const double column_deg = (b.east_deg - b.west_deg) / shape.columns,
                 row_deg = (b.north_deg - b.south_deg) / shape.rows;
    shape.spacing_m = radius_m * kDegree_rad * std::sqrt(column_deg * row_deg);
    shape.whole_turn = std::abs(b.east_deg - b.west_deg - 360) < 0.5 * column_deg;
    shape.pole_above_first_row = shape.whole_turn && std::abs(b.north_deg - 90) < 0.5 * row_deg;
    shape.pole_below_last_row = shape.whole_turn && std::abs(b.south_deg + 90) < 0.5 * row_deg;
}

// Returns the ratio of tan(planetocentric latitude) to tan(planetographic latitude), (b/a)^2 (Snyder, USGS
// Professional Paper 1395, 1987, eq. 3-28); 1 for planetographic maps.
inline double latitude_factor(const Figure& figure, bool planetocentric) {
    if (!planetocentric) return 1;
    const double ratio = figure.polar_radius_m / figure.equatorial_radius_m;
    return ratio * ratio;
}

inline double longitude_deg(Vec3d place) { return std::atan2(place.y, place.x) / kDegree_rad; }
inline double latitude_deg(Vec3d place, double factor) {
    return std::atan2(factor * place.z, std::hypot(place.x, place.y)) / kDegree_rad;
}

// Subtracts whole turns from a column; the result is from -0.5 to turn - 0.5.
inline double within_turn(double column, double columns_of_turn) {
    return column - columns_of_turn * std::floor((column + 0.5) / columns_of_turn);
}

// Returns the post at a place. factor: latitude_factor().
inline Vec2d post_at(const MapBounds& b, const GroundRaster::Shape& shape, Vec3d place, double factor) {
    const double per_deg = shape.columns / (b.east_deg - b.west_deg);
    const double turn = shape.whole_turn ? shape.columns : 360 * per_deg;
    return {within_turn((longitude_deg(place) - b.west_deg) * per_deg - 0.5, turn),
            (b.north_deg - latitude_deg(place, factor)) / (b.north_deg - b.south_deg) * shape.rows - 0.5};
}

}  // namespace hilcam
