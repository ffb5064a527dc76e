#include "render/sky/bodies.h"

#include <erfa.h>
#include <erfam.h>

#include <cmath>

#include "render/sky/body_source.h"
#include "render/sky/own_bodies.h"
#include "render/sky/planet_series.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kDay_s = 86400;

// Pole and prime meridian of Archinal et al. 2018 at T Julian centuries and d days of TDB since J2000 [deg].
struct Rotation {
    double right_ascension_deg, declination_deg, meridian_deg;
};

Rotation moon_rotation(double t, double d) {
    const auto argument = [&](double a, double rate) { return (a + rate * d) * kDegree_rad; };
    const double e1 = argument(125.045, -0.0529921), e2 = argument(250.089, -0.1059842),
                 e3 = argument(260.008, 13.0120009), e4 = argument(176.625, 13.3407154),
                 e5 = argument(357.529, 0.9856003), e6 = argument(311.589, 26.4057084),
                 e7 = argument(134.963, 13.0649930), e8 = argument(276.617, 0.3287146),
                 e9 = argument(34.226, 1.7484877), e10 = argument(15.134, -0.1589763),
                 e11 = argument(119.743, 0.0036096), e12 = argument(239.961, 0.1643573),
                 e13 = argument(25.053, 12.9590088);
    using std::cos, std::sin;
    return {269.9949 + 0.0031 * t - 3.8787 * sin(e1) - 0.1204 * sin(e2) + 0.0700 * sin(e3) -
                0.0172 * sin(e4) + 0.0072 * sin(e6) - 0.0052 * sin(e10) + 0.0043 * sin(e13),
            66.5392 + 0.0130 * t + 1.5419 * cos(e1) + 0.0239 * cos(e2) - 0.0278 * cos(e3) + 0.0068 * cos(e4) -
                0.0029 * cos(e6) + 0.0009 * cos(e7) + 0.0008 * cos(e10) - 0.0009 * cos(e13),
            38.3213 + 13.17635815 * d - 1.4e-12 * d * d + 3.5610 * sin(e1) + 0.1208 * sin(e2) -
                0.0642 * sin(e3) + 0.0158 * sin(e4) + 0.0252 * sin(e5) - 0.0066 * sin(e6) - 0.0047 * sin(e7) -
                0.0046 * sin(e8) + 0.0028 * sin(e9) + 0.0052 * sin(e10) + 0.0040 * sin(e11) +
                0.0019 * sin(e12) - 0.0044 * sin(e13)};
}

// Archinal et al. 2018, table 1; periodic terms below 0.1 deg are left out, except Neptune's.
Rotation planet_rotation(BodyId id, double t, double d) {
    const double n = (357.85 + 52.316 * t) * kDegree_rad;
    switch (id) {
        case BodyId::kMercury:
            return {281.0103 - 0.0328 * t, 61.4155 - 0.0049 * t, 329.5988 + 6.1385108 * d};
        case BodyId::kVenus:
            return {272.76, 67.16, 160.20 - 1.4813688 * d};
        case BodyId::kMars:
            return {317.68143 - 0.1061 * t, 52.88650 - 0.0609 * t, 176.630 + 350.89198226 * d};
        case BodyId::kJupiter:
            return {268.056595 - 0.006499 * t, 64.495303 + 0.002413 * t, 284.95 + 870.5360000 * d};
        case BodyId::kSaturn:
            return {40.589 - 0.036 * t, 83.537 - 0.004 * t, 38.90 + 810.7939024 * d};
        case BodyId::kUranus:
            return {257.311, -15.175, 203.81 - 501.1600928 * d};
        case BodyId::kNeptune:
            return {299.36 + 0.70 * std::sin(n), 43.46 - 0.51 * std::cos(n),
                    249.978 + 541.1397757 * d - 0.48 * std::sin(n)};
        default:
            return moon_rotation(t, d);
    }
}

double tdb_days(TimeTai time) {
    // TDB differs from TT by at most 2 ms (Fairhead & Bretagnon 1990), 60 m of the Earth's motion.
    const JulianDate tt = julian_tt(time);
    return (tt.day - ERFA_DJ00) + tt.fraction;
}

Planet planet_of(BodyId id) {
    switch (id) {
        case BodyId::kMercury:
            return Planet::kMercury;
        case BodyId::kVenus:
            return Planet::kVenus;
        case BodyId::kMars:
            return Planet::kMars;
        case BodyId::kJupiter:
            return Planet::kJupiter;
        case BodyId::kSaturn:
            return Planet::kSaturn;
        case BodyId::kUranus:
            return Planet::kUranus;
        default:
            return Planet::kNeptune;
    }
}

}  // namespace

namespace {

StateVector state_of(const double pv[2][3]) {
    constexpr double au = kAstronomicalUnit_m, per_day = kAstronomicalUnit_m / kDay_s;
    return {{au * pv[0][0], au * pv[0][1], au * pv[0][2]},
            {per_day * pv[1][0], per_day * pv[1][1], per_day * pv[1][2]}};
}

StateVector operator+(const StateVector& a, const StateVector& b) {
    return {a.position_m + b.position_m, a.velocity_m_s + b.velocity_m_s};
}

// One series gives both.
struct EarthAndSun {
    StateVector earth_from_sun, sun_from_barycenter;
};
EarthAndSun earth_and_sun(TimeTai time) {
    const JulianDate tt = julian_tt(time);
    double from_sun[2][3], from_barycenter[2][3];
    eraEpv00(tt.day, tt.fraction, from_sun, from_barycenter);
    const StateVector earth = state_of(from_sun), whole = state_of(from_barycenter);
    return {earth, {whole.position_m - earth.position_m, whole.velocity_m_s - earth.velocity_m_s}};
}

// earth: its state at that time.
StateVector heliocentric(BodyId id, TimeTai time, const StateVector& earth) {
    if (id == BodyId::kEarth) return earth;
    if (id == BodyId::kMoon) {
        const JulianDate tt = julian_tt(time);
        double moon[2][3];
        eraMoon98(tt.day, tt.fraction, moon);
        return earth + state_of(moon);
    }
    const PlanetState planet = planet_by_series(planet_of(id), tdb_days(time));
    return {kAstronomicalUnit_m * planet.position_au, kAstronomicalUnit_m / kDay_s * planet.velocity_au_d};
}

}  // namespace

StateVector heliocentric(BodyId id, TimeTai time) {
    return heliocentric(id, time, earth_and_sun(time).earth_from_sun);
}

Vec3d sun_from_earth_m(TimeTai time) { return -heliocentric(BodyId::kEarth, time).position_m; }

Mat3d earth_fixed_from_icrf(TimeTai time, const EarthOrientation& measured) {
    const JulianDate tt = julian_tt(time);
    const JulianDate ut1 = julian_ut1(time, measured.ut1_minus_utc_s);
    double m[3][3];
    eraC2t00b(tt.day, tt.fraction, ut1.day, ut1.fraction, measured.pole_x_rad, measured.pole_y_rad, m);
    return {{m[0][0], m[0][1], m[0][2]}, {m[1][0], m[1][1], m[1][2]}, {m[2][0], m[2][1], m[2][2]}};
}

Mat3d earth_rotated_from_icrf(TimeTai time, const EarthOrientation& measured) {
    return earth_fixed_from_icrf(time, {measured.ut1_minus_utc_s, 0, 0});
}

Mat3d body_fixed_from_icrf(BodyId id, TimeTai time, const EarthOrientation& measured) {
    if (id == BodyId::kEarth) return earth_fixed_from_icrf(time, measured);
    const double d = tdb_days(time);
    const Rotation r = planet_rotation(id, d / 36525, d);
    // Archinal et al. 2018, figure 1: node on the ICRF equator at RA + 90, tilt 90 - Dec, then W along the
    // body's equator.
    const double node = (90 + r.right_ascension_deg) * kDegree_rad,
                 tilt = (90 - r.declination_deg) * kDegree_rad;
    const double w = std::fmod(r.meridian_deg, 360.0) * kDegree_rad;
    const auto about_z = [](double angle) {
        const double c = std::cos(angle), s = std::sin(angle);
        return Mat3d{{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
    };
    const double c = std::cos(tilt), s = std::sin(tilt);
    const Mat3d about_x{{1, 0, 0}, {0, c, s}, {0, -s, c}};
    return about_z(w) * (about_x * about_z(node));
}

namespace {

// earth: its state by the series.
StateVector known_heliocentric(BodyId id, TimeTai time, const OriginConfig& origin,
                               const StateVector& earth) {
    if (origin.source)
        if (const auto known = origin.source->from_sun(id, time)) return *known;
    return heliocentric(id, time, earth);
}

}  // namespace

StateVector heliocentric(BodyId id, TimeTai time, const OriginConfig& origin) {
    return known_heliocentric(id, time, origin, earth_and_sun(time).earth_from_sun);
}

Mat3d body_fixed_from_icrf(BodyId id, TimeTai time, const OriginConfig& origin) {
    if (origin.source)
        if (const auto known = origin.source->fixed_from_icrf(id, time)) return *known;
    return body_fixed_from_icrf(id, time, origin.earth);
}

StateVector origin_from_sun(TimeTai time, const OriginConfig& origin) {
    if (const std::optional<BodyId> center = origin.center()) return heliocentric(*center, time, origin);
    if (origin.kind == OriginConfig::Kind::kSpice) return origin.source->origin_from_sun(time);
    return {-origin.sun_m, {}};
}

Vec3d earth_fixed_position_m(const Geodetic& place) { return body_fixed_position_m(BodyId::kEarth, place); }

Vec3d body_fixed_position_m(BodyId id, const Geodetic& place) {
    const Figure& figure = kFigures[index_of(id)];
    const double flattening = 1 - figure.polar_radius_m / figure.equatorial_radius_m;
    double xyz[3];
    HILCAM_CHECK(eraGd2gce(figure.equatorial_radius_m, flattening, place.longitude_rad, place.latitude_rad,
                           place.height_m, xyz) == 0);
    return {xyz[0], xyz[1], xyz[2]};
}

Mat3d body_fixed_from_local(const Geodetic& place) {
    const double lon = place.longitude_rad, lat = place.latitude_rad;
    const Vec3d east{-std::sin(lon), std::cos(lon), 0};
    const Vec3d up{std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
    return transposed(Mat3d{east, cross(up, east), up});
}

Fields fields(OriginConfig& c) {
    std::vector<std::string> names(kBodyNames.begin(), kBodyNames.end());
    return {
        choice("kind", c.kind, {"earth_center", "earth_fixed", "body_center", "body_fixed", "free", "spice"},
               "kind of origin: the centre of a body, a place that turns with it, free space, or a SPICE "
               "object. In free space the origin is at rest relative to the Sun, sun.direction places the "
               "Sun, and only bodies with 'visible: true' are shown"),
        optional(
            text("object", c.object, "SPICE object at the origin, for kind spice: a name or a NAIF code"),
            c.has_object),
        optional(choice("body", c.body, names, "body of the kinds body_center and body_fixed"), c.has_body),
        optional(number("longitude_deg", c.place.longitude_rad, kDegree_rad, {-360, 360},
                        "longitude of a fixed origin, east positive"),
                 c.has_longitude),
        optional(number("latitude_deg", c.place.latitude_rad, kDegree_rad, {-90, 90},
                        "geodetic latitude of a fixed origin"),
                 c.has_latitude),
        optional(number("height_km", c.place.height_m, 1e3, {-10, 1e9},
                        "height of a fixed origin above the body's ellipsoid (Earth: WGS 84)"),
                 c.has_height),
    };
}

void validate(const OriginConfig& c) {
    using Kind = OriginConfig::Kind;
    constexpr std::array kWords = {"earth_center", "earth_fixed", "body_center",
                                   "body_fixed",   "free",        "spice"};
    const auto forbid = [&](bool given, const char* key, bool is_read, const char* readers) {
        if (given && !is_read)
            throw KeyError(key, std::string("has no effect with kind: ") +
                                    kWords[static_cast<std::size_t>(c.kind)] +
                                    "; accepted: kind: " + readers + ", or no '" + key + "'");
    };
    const bool names_body = c.kind == Kind::kBodyCenter || c.kind == Kind::kBodyFixed;
    forbid(c.has_body, "body", names_body, "body_center or body_fixed");
    forbid(c.has_object, "object", c.kind == Kind::kSpice, "spice");
    if (c.kind == Kind::kSpice && c.object.empty())
        throw KeyError("object", "is not given; kind: spice needs it; accepted: a name or NAIF's code");
    for (const auto& [given, key] : {std::pair{c.has_longitude, "longitude_deg"},
                                     {c.has_latitude, "latitude_deg"},
                                     {c.has_height, "height_km"}})
        forbid(given, key, c.turns(), "earth_fixed or body_fixed");
}

namespace {

// Returns the state of a place on a rotating body, about its centre: by a difference over a minute, good to
// mm/s; aberration needs m/s.
StateVector place_from_center(TimeTai time, const OriginConfig& origin) {
    if (!origin.turns()) return {};
    constexpr std::int64_t kStep_ns = 30'000'000'000;
    const BodyId center = *origin.center();
    const Vec3d fixed_m = body_fixed_position_m(center, origin.place);
    const auto at = [&](TimeTai t) { return transposed(body_fixed_from_icrf(center, t, origin)) * fixed_m; };
    return {at(time), (at(time + kStep_ns) - at(time + -kStep_ns)) / (2 * kStep_ns * kSecondsPerNs)};
}

// Returns the velocity over that of light, limited below 1: a faster observer sees what one nearly as fast as
// light sees.
Vec3d beta_of(Vec3d velocity_m_s) {
    constexpr double kMax = 1 - 1e-6;
    const Vec3d beta = velocity_m_s / kSpeedOfLight_m_s;
    const double size = length(beta);
    return size > kMax ? (kMax / size) * beta : beta;
}

}  // namespace

Vec3d aberrated(Vec3d dir, Vec3d velocity_m_s) {
    double natural[3] = {dir.x, dir.y, dir.z};
    const Vec3d beta = beta_of(velocity_m_s);
    double v[3] = {beta.x, beta.y, beta.z};
    const double inverse_lorentz = std::sqrt(1 - (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
    double proper[3];
    // The distance to the Sun only serves light bending by the Sun (4 mas at most here), so it is set to
    // infinity.
    eraAb(natural, v, 1e9, inverse_lorentz, proper);
    return {proper[0], proper[1], proper[2]};
}

Bodies bodies_at(TimeTai time, const OriginConfig& origin) {
    const std::optional<BodyId> center = origin.center();
    const bool free = origin.kind == OriginConfig::Kind::kFree;
    HILCAM_CHECK(!free || length(origin.sun_m) > 0);
    auto [earth, sun] = earth_and_sun(time);
    if (origin.source) sun = origin.source->sun_from_barycenter(time).value_or(sun);
    const StateVector home =
        center ? known_heliocentric(*center, time, origin, earth) : origin_from_sun(time, origin);
    const StateVector place = place_from_center(time, origin);
    Bodies out;
    out.origin_from_barycenter = sun + home + place;

    // As seen from the home body's centre or the place in free space, then from the origin.
    const auto apparent = [&](Vec3d from_home_m) {
        return seen_in_motion(from_home_m, 0, out.origin_from_barycenter.velocity_m_s) - place.position_m;
    };
    const double sun_light_s = length(home.position_m) / kSpeedOfLight_m_s;
    out.sun_world_m = free ? origin.sun_m : apparent(-home.position_m - sun_light_s * sun.velocity_m_s);
    for (std::size_t i = 0; i < kBodyCount; ++i) {
        const auto id = static_cast<BodyId>(i);
        if (id == center) {
            out.body[i] = {-place.position_m, body_fixed_from_icrf(id, time, origin), -place.velocity_m_s};
            continue;
        }
        // One step of light time: the planet moves less than 1e-4 of the distance meanwhile. Its velocity is
        // relative to the barycentre, like the observer's.
        StateVector there = known_heliocentric(id, time, origin, earth);
        const double light_s = length(there.position_m - home.position_m) / kSpeedOfLight_m_s;
        there.position_m = there.position_m - light_s * (there.velocity_m_s + sun.velocity_m_s);
        const TimeTai then = time + -static_cast<std::int64_t>(light_s * 1e9);
        out.body[i] = {
            apparent(there.position_m - home.position_m), body_fixed_from_icrf(id, then, origin), {}};
    }
    if (origin.own) place_own_bodies(time, *origin.own, center, out);
    return out;
}

Vec3d seen_in_motion(Vec3d to_body_m, double radius_m, Vec3d velocity_m_s) {
    const Vec3d beta = beta_of(velocity_m_s);
    const double beta2 = dot(beta, beta);
    if (!(beta2 > 0)) return to_body_m;
    const double gamma = 1 / std::sqrt(1 - beta2);
    const double to_limb_m = std::sqrt(std::max(0.0, dot(to_body_m, to_body_m) - radius_m * radius_m));
    return to_body_m + ((gamma - 1) * dot(to_body_m, beta) / beta2 + gamma * to_limb_m) * beta;
}

}  // namespace hilcam
