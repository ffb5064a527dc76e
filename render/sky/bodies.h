#pragma once
// The Sun, the Moon and the planets: positions, attitudes and sizes.
//
// Positions in the world are those that an observer at rest at its origin sees: they include light time and
// stellar aberration by the origin's own velocity, except for the body that the origin belongs to. A camera
// that moves in the world sees them shifted once more (seen_in_motion).

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/earth_orientation.h"
#include "render/vocabulary/mesh.h"
#include "render/vocabulary/pose.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// An index into Bodies and Scene::bodies.
enum class BodyId : std::uint8_t {
    kMercury,
    kVenus,
    kEarth,
    kMoon,
    kMars,
    kJupiter,
    kSaturn,
    kUranus,
    kNeptune
};
inline constexpr std::size_t kBodyCount = 9;
inline constexpr std::array<std::string_view, kBodyCount> kBodyNames = {
    "mercury", "venus", "earth", "moon", "mars", "jupiter", "saturn", "uranus", "neptune"};
// The scenario's own bodies (own_bodies.h) follow these.
inline constexpr std::size_t kMaxOwnBodies = 8;
inline constexpr std::size_t kMaxBodies = kBodyCount + kMaxOwnBodies;
inline constexpr BodyId kNoBody{kMaxBodies};
inline constexpr std::size_t index_of(BodyId id) { return static_cast<std::size_t>(id); }

// An ellipsoid of revolution about its z axis.
struct Figure {
    double equatorial_radius_m;
    double polar_radius_m;
};
// Archinal et al., Celest. Mech. Dyn. Astron. 130:22 (2018), tables 4 and 5; the Earth's is WGS 84.
inline constexpr std::array<Figure, kBodyCount> kFigures = {{
    {2440.53e3, 2438.26e3},
    {6051.8e3, 6051.8e3},
    {kEarthEquatorialRadius_m, kEarthEquatorialRadius_m*(1 - kEarthFlattening)},
    {1737.4e3, 1737.4e3},
    {3396.19e3, 3376.20e3},
    {71492e3, 66854e3},
    {60268e3, 54364e3},
    {25559e3, 24973e3},
    {24764e3, 24341e3},
}};

// Returns the geocentric geometric position of the Sun [m], ICRF axes: minus the heliocentric Earth of ERFA's
// eraEpv00 (VSOP2000 fit, good to 14 km from 1900 to 2100).
Vec3d sun_from_earth_m(TimeTai time);
// Heliocentric geometric position and velocity [m, m/s], ICRF axes. Earth: eraEpv00. Moon: the same plus
// eraMoon98 (Meeus' series; 10 arcsec, 50 km). Planets: planet_by_series() (planet_series.h).
struct StateVector {
    Vec3d position_m, velocity_m_s;
};
StateVector heliocentric(BodyId id, TimeTai time);

// Returns the rotation from ICRF to ITRF axes: IAU 2006/2000B precession-nutation and Earth rotation angle
// (ERFA eraC2t00b), with the measured pole and UT1.
Mat3d earth_fixed_from_icrf(TimeTai time, const EarthOrientation& measured);
// Returns the rotation to the Earth's axes about the celestial intermediate pole, without polar motion.
Mat3d earth_rotated_from_icrf(TimeTai time, const EarthOrientation& measured);
// Returns the rotation to a body's own axes (z: north pole, x: prime meridian). Earth as above; others by
// Archinal et al. 2018 (the Moon's mean-Earth frame by its series, 0.01 deg).
Mat3d body_fixed_from_icrf(BodyId id, TimeTai time, const EarthOrientation& measured);

// A place on a body: angles in rad, height above its ellipsoid in m. Latitude is geodetic (that of the
// normal).
struct Geodetic {
    double longitude_rad = 0;
    double latitude_rad = 0;
    double height_m = 0;
};
Vec3d earth_fixed_position_m(const Geodetic& place);
Vec3d body_fixed_position_m(BodyId id, const Geodetic& place);
// Returns the rotation from the local axes of a place (x east, y north, z up along the ellipsoid's normal) to
// the body's.
Mat3d body_fixed_from_local(const Geodetic& place);

// The origin of the scenario's world: a body's centre, a place on a rotating body, a place in free space at
// rest relative to the Sun, or an object of SPICE kernels.
struct OwnBodies;
class BodySource;
struct OriginConfig {
    enum class Kind {
        kEarthCenter,
        kEarthFixed,
        kBodyCenter,
        kBodyFixed,
        kFree,
        kSpice
    } kind = Kind::kEarthCenter;
    BodyId body = BodyId::kEarth;
    // The place for the fixed kinds of origin, for example a geostationary longitude with height 35 786 km.
    Geodetic place;
    EarthOrientation earth;  // not a key of this section: `earth_orientation` of the scenario
    Vec3d sun_m;  // position of the Sun for kFree; not a key of this section (emulator/scenario/free_space.h)
    std::shared_ptr<const OwnBodies> own;      // `bodies` of the scenario; null: none
    std::string object;                        // object of the kernels, for kSpice
    std::shared_ptr<const BodySource> source;  // kernels of the scenario; null: the program's own series
    bool has_object = false, has_body = false, has_longitude = false, has_latitude = false,
         has_height = false;

    // Returns the body that the origin belongs to; none for free space and objects of kernels.
    std::optional<BodyId> center() const {
        if (kind == Kind::kFree || kind == Kind::kSpice) return std::nullopt;
        return kind == Kind::kBodyCenter || kind == Kind::kBodyFixed ? body : BodyId::kEarth;
    }
    bool turns() const { return kind == Kind::kEarthFixed || kind == Kind::kBodyFixed; }
};
Fields fields(OriginConfig& config);
// Throws KeyError for a key that this kind does not use.
void validate(const OriginConfig& config);

// The same as above, from the origin's source if that has the data. Loop.
StateVector heliocentric(BodyId id, TimeTai time, const OriginConfig& origin);
Mat3d body_fixed_from_icrf(BodyId id, TimeTai time, const OriginConfig& origin);
// Returns the state of what the origin belongs to: the body's centre, the place in free space, the object of
// the kernels.
StateVector origin_from_sun(TimeTai time, const OriginConfig& origin);

// The state of a body in the world at an instant.
struct BodyState {
    Vec3d world_m;
    Mat3d fixed_from_world;
    // Its motion in the world if the origin rotates with it; world_m does not include the light time of this
    // motion.
    Vec3d velocity_m_s;
    Figure figure{};  // for bodies of the scenario; others use kFigures
};
struct Bodies {
    Vec3d sun_world_m;
    StateVector origin_from_barycenter;  // ICRF axes
    std::array<BodyState, kMaxBodies> body;

    BodyState& operator[](BodyId id) { return body[index_of(id)]; }
    const BodyState& operator[](BodyId id) const { return body[index_of(id)]; }
    const Figure& figure(BodyId id) const {
        return index_of(id) < kBodyCount ? kFigures[index_of(id)] : (*this)[id].figure;
    }
    const BodyState& earth() const { return (*this)[BodyId::kEarth]; }
};
// Takes some hundred microseconds. Loop, no allocation.
Bodies bodies_at(TimeTai time, const OriginConfig& origin);

// Returns a direction as an observer with this velocity sees it (ERFA eraAb, relativistic, without light
// bending by the Sun).
Vec3d aberrated(Vec3d dir, Vec3d observer_velocity_m_s);
// Returns where a moving observer sees the middle of the disk of a body at `to_body_m`. The outline of a
// moving sphere is a circle (Penrose, Proc. Camb. Phil. Soc. 55, 1959, 137), and a sphere of the same radius
// at the returned place has that outline. Exact: the cone of the limb's directions is the 4-vector of the
// tangent's length and the middle's position, and is boosted as such. A radius of 0 gives aberration.
Vec3d seen_in_motion(Vec3d to_body_m, double radius_m, Vec3d observer_velocity_m_s);

// Body axes with z stretched so that the ellipsoid is a sphere.
inline Vec3d stretched(const Figure& figure, Vec3d v) {
    return {v.x, v.y, v.z * figure.equatorial_radius_m / figure.polar_radius_m};
}
// Returns the cosine of half the angle of a ball at a distance; 0 inside it.
inline double cone_cosine_of(double radius_m, double distance_m) {
    const double sine = radius_m < distance_m ? radius_m / distance_m : 1.0;
    return std::sqrt(1 - sine * sine);
}
// True when a disk of one half angle can touch another disk at an angle from it; all given by cosines.
inline bool can_cover(double cosine_between, double one_cosine, double other_cosine) {
    const auto angle = [](double cosine) { return std::acos(std::fmin(1.0, std::fmax(-1.0, cosine))); };
    return angle(cosine_between) < angle(one_cosine) + angle(other_cosine);
}

// Returns the nearer intersection of a ray from outside with an ellipsoid, in lengths of the direction;
// negative: none. Origin and direction in its axes, metres from its centre. Closed form in double.
inline double intersect_ellipsoid(const Figure& figure, Vec3d origin_m, Vec3d dir) {
    // Scaling z by a/b makes the ellipsoid a sphere of radius a. Then the closest-approach form of the
    // quadratic keeps its digits for distant origins (Haines et al., Ray Tracing Gems, 2019, ch. 7).
    const double a = figure.equatorial_radius_m;
    const double stretch = a / figure.polar_radius_m;
    const Vec3d o{origin_m.x, origin_m.y, origin_m.z * stretch};
    const Vec3d d{dir.x, dir.y, dir.z * stretch};
    const double d_squared = dot(d, d);
    const double to_closest = -dot(o, d) / d_squared;
    const Vec3d closest = o + to_closest * d;
    // a^2 - c^2 as a product, because the two are similar near the limb.
    const double distance = length(closest);
    const double rest = (a - distance) * (a + distance);
    if (rest < 0 || to_closest < 0) return -1;
    return to_closest - std::sqrt(rest / d_squared);
}
inline double intersect_earth(Vec3d origin_m, Vec3d dir) {
    return intersect_ellipsoid(kFigures[index_of(BodyId::kEarth)], origin_m, dir);
}

// Returns the angle [rad], in [0, pi/2], from an axis that meets an ellipsoid to the tangent rays in a plane
// through the axis; pi/2 if there are none. Origin in its axes, metres from its centre; axis and way are unit
// vectors at right angles, way in the plane. A line along d meets a sphere of radius a if a^2 d.d - (o x
// d).(o x d) >= 0: a quadratic in the tangent of the angle, whose terms keep their digits for distant
// origins.
inline double limb_angle_rad(const Figure& figure, Vec3d origin_m, Vec3d axis, Vec3d way) {
    const double a = figure.equatorial_radius_m, stretch = a / figure.polar_radius_m;
    const auto stretched = [stretch](Vec3d v) { return Vec3d{v.x, v.y, v.z * stretch}; };
    const Vec3d o = stretched(origin_m), along = stretched(axis), across = stretched(way);
    const Vec3d u = cross(o, along), v = cross(o, across);
    const double c0 = a * a * dot(along, along) - dot(u, u);
    const double c1 = a * a * dot(along, across) - dot(u, v);
    const double c2 = a * a * dot(across, across) - dot(v, v);
    if (c0 <= 0) return 0;
    // The smallest positive root of c2 t^2 + 2 c1 t + c0.
    const double rest = c1 * c1 - c2 * c0;
    const double below = rest >= 0 ? std::sqrt(rest) - c1 : 0;
    return below > 0 ? std::atan2(c0, below) : 0.5 * kPi;
}

// Returns the outward unit normal of an ellipsoid at a point on it.
inline Vec3d ellipsoid_normal(const Figure& figure, Vec3d point_m) {
    // The gradient of x^2/a^2 + y^2/a^2 + z^2/b^2.
    const double ratio = figure.polar_radius_m / figure.equatorial_radius_m;
    return normalized(Vec3d{point_m.x, point_m.y, point_m.z / (ratio * ratio)});
}
inline Vec3d earth_normal(Vec3d point_m) {
    return ellipsoid_normal(kFigures[index_of(BodyId::kEarth)], point_m);
}

}  // namespace hilcam
