#include "render/bodies.h"

#include <erfa.h>
#include <erfam.h>

#include <cmath>

#include "render/check.h"
#include "render/units.h"

namespace hilcam {

Vec3d sun_from_earth_m(TimeTai time) {
    // TDB differs from TT by at most 2 ms (Fairhead & Bretagnon 1990), 60 m of Earth's motion.
    const JulianDate tt = julian_tt(time);
    double heliocentric[2][3];
    double barycentric[2][3];
    eraEpv00(tt.day, tt.fraction, heliocentric, barycentric);
    const double* earth_au = heliocentric[0];
    return -kAstronomicalUnit_m * Vec3d{earth_au[0], earth_au[1], earth_au[2]};
}

Mat3d earth_fixed_from_icrf(TimeTai time) {
    const JulianDate tt = julian_tt(time);
    const JulianDate ut1 = julian_ut1(time);
    double m[3][3];
    eraC2t00b(tt.day, tt.fraction, ut1.day, ut1.fraction, 0.0, 0.0, m);
    return {{m[0][0], m[0][1], m[0][2]}, {m[1][0], m[1][1], m[1][2]}, {m[2][0], m[2][1], m[2][2]}};
}

Vec3d earth_fixed_position_m(const Geodetic& place) {
    double xyz[3];
    HILCAM_CHECK(eraGd2gc(ERFA_WGS84, place.longitude_rad, place.latitude_rad, place.height_m, xyz) == 0);
    return {xyz[0], xyz[1], xyz[2]};
}

Fields fields(OriginConfig& c) {
    return {
        choice("kind", c.kind, {"earth_center", "earth_fixed"},
               "what the world's origin is: the centre of the Earth, or a place that turns with it"),
        number("longitude_deg", c.place.longitude_rad, kDegree_rad, {-360, 360},
               "of an earth_fixed origin, east positive"),
        number("latitude_deg", c.place.latitude_rad, kDegree_rad, {-90, 90},
               "of an earth_fixed origin, geodetic"),
        number("height_km", c.place.height_m, 1e3, {-10, 1e9},
               "of an earth_fixed origin above the WGS 84 ellipsoid"),
    };
}

Bodies bodies_at(TimeTai time, const OriginConfig& origin) {
    const Mat3d earth_fixed_from_world = earth_fixed_from_icrf(time);
    Vec3d origin_from_earth_m;
    if (origin.kind == OriginConfig::Kind::kEarthFixed)
        origin_from_earth_m = transposed(earth_fixed_from_world) * earth_fixed_position_m(origin.place);
    return {sun_from_earth_m(time) - origin_from_earth_m, -origin_from_earth_m, earth_fixed_from_world};
}

Fields fields(EarthConfig& c) {
    return {
        flag("visible", c.visible, "whether the Earth is drawn, reflected and shines on the objects"),
        curve("albedo", c.albedo, {0, 1}, "Lambert albedo, or the factor on the map's reflectance"),
        path("albedo_map", c.albedo_map, "equirectangular picture, left edge 180 W, top 90 N; none: uniform"),
    };
}

}  // namespace hilcam
