#pragma once
// The Sun and the Earth: where they are, how the Earth is turned, how it reflects.

#include <cmath>
#include <filesystem>

#include "render/config_field.h"
#include "render/mesh.h"
#include "render/pose.h"
#include "render/spectrum.h"
#include "render/units.h"

namespace hilcam {

// Geocentric position of the Sun [m], ICRF axes: minus the heliocentric Earth of ERFA's eraEpv00 (VSOP2000
// fit, good to 14 km from 1900 to 2100). Light time and aberration (20 arcsec) are left out.
Vec3d sun_from_earth_m(TimeTai time);

// The rotation that takes ICRF vectors into ITRF axes: IAU 2006/2000B precession-nutation and Earth rotation
// angle (ERFA eraC2t00b), no polar motion (below 0.5 arcsec), UT1 = UTC (below 14 arcsec).
Mat3d earth_fixed_from_icrf(TimeTai time);

// Position on the WGS 84 ellipsoid in ITRF axes [m] (ERFA eraGd2gc). Angles in rad, height above the
// ellipsoid in m.
struct Geodetic {
    double longitude_rad = 0;
    double latitude_rad = 0;
    double height_m = 0;
};
Vec3d earth_fixed_position_m(const Geodetic& place);

// The scenario's world origin, which may ride with the rotating Earth.
struct OriginConfig {
    enum class Kind { kEarthCenter, kEarthFixed } kind = Kind::kEarthCenter;
    Geodetic place;  // kEarthFixed: a geostationary longitude with height 35 786 km, say
};
Fields fields(OriginConfig& config);

// Where the bodies stand in the world at an instant.
struct Bodies {
    Vec3d sun_world_m;
    Vec3d earth_world_m;
    Mat3d earth_fixed_from_world;
};
Bodies bodies_at(TimeTai time, const OriginConfig& origin);

// The Earth as a Lambert ellipsoid in direct Sun; no air, no clouds of its own.
struct EarthConfig {
    bool visible = true;
    Curve albedo = Curve::constant(0.3);  // of a uniform Earth; with a map: a factor on its reflectance
    std::filesystem::path
        albedo_map;  // equirectangular sRGB picture of reflectance, left edge 180 W, top 90 N
};
Fields fields(EarthConfig& config);

// The nearer intersection of a ray from outside with the Earth's ellipsoid. Origin and direction in ITRF
// axes, metres from the Earth's centre. Closed form in double. Distance in lengths of the direction, or a
// negative value: no hit.
inline double intersect_earth(Vec3d origin_m, Vec3d dir) {
    // Scaling z by a/b turns the ellipsoid into a sphere of radius a; then the closest-approach form of the
    // quadratic, which keeps its digits for far origins (Haines et al., Ray Tracing Gems, 2019, ch. 7).
    constexpr double a = kEarthEquatorialRadius_m;
    constexpr double stretch = 1.0 / (1.0 - kEarthFlattening);
    const Vec3d o{origin_m.x, origin_m.y, origin_m.z * stretch};
    const Vec3d d{dir.x, dir.y, dir.z * stretch};
    const double d_squared = dot(d, d);
    const double to_closest = -dot(o, d) / d_squared;
    const Vec3d closest = o + to_closest * d;
    const double rest = a * a - dot(closest, closest);
    if (rest < 0 || to_closest < 0) return -1;
    return to_closest - std::sqrt(rest / d_squared);
}

// The outward unit normal of the ellipsoid at a point on it (ITRF axes).
inline Vec3d earth_normal(Vec3d point_m) {
    // Gradient of x^2/a^2 + y^2/a^2 + z^2/b^2.
    constexpr double ratio = (1.0 - kEarthFlattening) * (1.0 - kEarthFlattening);
    return normalized(Vec3d{point_m.x, point_m.y, point_m.z / ratio});
}

}  // namespace hilcam
