// When: 1950 to 2100.

#include <chrono>

#include "render/sky/bodies.h"
#include "render/vocabulary/units.h"
#include "tests/extremes/groups.h"

namespace hilcam::extremes {
namespace {

constexpr std::int64_t kNs = 1'000'000'000;

struct Date {
    int year;
    unsigned month, day;
};
// Civil days since 1970-01-01 (the standard library's proleptic Gregorian calendar).
std::int64_t days_of(Date d) {
    using namespace std::chrono;
    return sys_days(year_month_day(year(d.year), month(d.month), day(d.day))).time_since_epoch().count();
}
// An instant of terrestrial time, TAI + 32.184 s.
TimeTai from_tt(Date date, double seconds) {
    return {days_of(date) * 86400 * kNs + std::llround((seconds - 32.184) * 1e9)};
}

}  // namespace

Group instants() {
    Group group{
        "Instants",
        "Time: UTC as text",
        "instant",
        {"TAI since 1970 [s]", "text and back [s]"},
        "civil days of 86,400 s and the leap seconds since (IERS Bulletin C: 10 s from 1972, 37 s from 2017 "
        "on); before 1960 there was no UTC, and TAI - UT is taken as 0. The error is in seconds.",
        "1 ns.",
        {}};
    struct Row {
        const char* text;
        Date date;
        int leap_s;
    };
    for (const Row& row : {Row{"1950-01-01T00:00:00.000Z", {1950, 1, 1}, 0},
                           {"1959-12-31T00:00:00.000Z", {1959, 12, 31}, 0},
                           {"1972-01-01T00:00:00.000Z", {1972, 1, 1}, 10},
                           {"2000-01-01T00:00:00.000Z", {2000, 1, 1}, 32},
                           {"2016-12-31T00:00:00.000Z", {2016, 12, 31}, 36},
                           {"2017-01-01T00:00:00.000Z", {2017, 1, 1}, 37},
                           {"2038-01-20T00:00:00.000Z", {2038, 1, 20}, 37},
                           {"2050-07-02T00:00:00.000Z", {2050, 7, 2}, 37},
                           {"2100-12-31T00:00:00.000Z", {2100, 12, 31}, 37}})
        group.cases.push_back(
            {row.text, {1e-9, 1e-9}, [row] {
                 const std::int64_t truth = (days_of(row.date) * 86400 + row.leap_s) * kNs;
                 const TimeTai found = parse_utc(row.text),
                               again = parse_utc(format_utc({truth + 250'000'000}));
                 const auto seconds = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-9; };
                 return std::vector<Found>{
                     {seconds(truth), std::abs(seconds(found.ns - truth))},
                     {seconds(truth) + 0.25, std::abs(seconds(again.ns - truth - 250'000'000))}};
             }});
    return group;
}

// How far the axis of the Moon's shadow passes from the Earth's centre.
Group eclipses() {
    Group group{
        "Eclipses",
        "Time: the Moon's shadow at the greatest eclipse",
        "instant (TT)",
        {"distance of its axis from the Earth's centre, north positive [Earth radii]"},
        "gamma of F. Espenak's Besselian elements (NASA GSFC, VSOP87 and ELP2000-82).",
        "18.3 arcsec of the Moon, the worst that ERFA states of its series from 1950 to 2100 (note 3 of "
        "eraMoon98), at the Moon's mean distance of 60.3 radii.",
        {}};
    struct Row {
        const char* text;
        Date date;
        double seconds, gamma;
    };
    const auto at = [](int hour, int minute, double second) { return hour * 3600 + minute * 60 + second; };
    for (const Row& row : {Row{"1950-03-18 15:32:01", {1950, 3, 18}, at(15, 32, 1.3), -0.9988},
                           {"1950-09-12 03:38:47", {1950, 9, 12}, at(3, 38, 46.9), 0.8903},
                           {"1973-06-30 11:38:41", {1973, 6, 30}, at(11, 38, 41), -0.0785},
                           {"1991-07-11 19:07:01", {1991, 7, 11}, at(19, 7, 0.8), -0.0041},
                           {"1999-08-11 11:04:09", {1999, 8, 11}, at(11, 4, 9), 0.5062},
                           {"2060-04-30 10:10:00", {2060, 4, 30}, at(10, 9, 59.8), 0.2422},
                           {"2099-03-21 22:54:32", {2099, 3, 21}, at(22, 54, 32), -0.4016},
                           {"2100-03-10 22:28:11", {2100, 3, 10}, at(22, 28, 11.0), 0.3077}})
        group.cases.push_back({row.text, {18.3 * kArcsecond_rad * 60.3}, [row] {
                                   const Bodies bodies = bodies_at(from_tt(row.date, row.seconds), {});
                                   const Vec3d moon = bodies[BodyId::kMoon].world_m,
                                               axis = normalized(bodies.sun_world_m - moon);
                                   const Vec3d nearest = moon - dot(moon, axis) * axis;
                                   const double gamma =
                                       std::copysign(length(nearest), nearest.z) / kEarthEquatorialRadius_m;
                                   return std::vector<Found>{{row.gamma, std::abs(gamma - row.gamma)}};
                               }});
    return group;
}

Group poles() {
    Group group{
        "Poles",
        "Time: the Earth's axis",
        "instant (TT)",
        {"its angle from the ICRF's pole [arcsec]"},
        "precession after Lieske et al. (A&A 58, 1, 1977): 2004.3109 T - 0.42665 T^2 - 0.041833 T^3. The "
        "error "
        "is of the pole's direction, at -zeta.",
        "the nutation that it leaves out, at most 19.6 arcsec of longitude (times sin 23.4 deg) and 10.2 of "
        "obliquity (IAU 1980: 17.2 and 9.2, and the half-yearly 1.3 and 0.6, the rest below 0.5); its rate, "
        "0.3 arcsec a century wrong; 0.02 of the frames.",
        {}};
    for (const int year : {1950, 2000, 2026, 2050, 2100})
        group.cases.push_back(
            {std::to_string(year) + "-01-01 12:00",
             {std::hypot(19.6 * std::sin(23.44 * kDegree_rad), 10.2) + 0.4},
             [year] {
                 const TimeTai time = from_tt({year, 1, 1}, 43200);
                 const double t = static_cast<double>(days_of({year, 1, 1}) - days_of({2000, 1, 1})) / 36525;
                 const double theta = (2004.3109 + (-0.42665 - 0.041833 * t) * t) * t * kArcsecond_rad;
                 const double zeta = (2306.2181 + (0.30188 + 0.017998 * t) * t) * t * kArcsecond_rad;
                 // The pole of date: theta from the old one towards right ascension -zeta.
                 const Vec3d truth{std::sin(theta) * std::cos(zeta), -std::sin(theta) * std::sin(zeta),
                                   std::cos(theta)};
                 const Vec3d pole = earth_fixed_from_icrf(time, {}).z;
                 return std::vector<Found>{
                     {std::abs(theta) / kArcsecond_rad, angle_between_rad(pole, truth) / kArcsecond_rad}};
             }});
    return group;
}

// A planet by mean elements of another source.
Group planets() {
    Group group{"Planets",
                "Time: Mars",
                "instant (TT)",
                {"distance from the Sun [au]; the error is its direction's [arcsec]"},
                "Kepler's equation with the elements of Standish & Williams, table 8.10.3 (Explanatory "
                "Supplement to the "
                "Astronomical Almanac, 3rd ed., 2013), right to 100 arcsec from 3000 BC to 3000 AD.",
                "those, and the 20 arcsec of bodies.h.",
                {}};
    for (const int year : {1950, 1975, 2000, 2025, 2050, 2075, 2100})
        group.cases.push_back(
            {std::to_string(year) + "-01-01 12:00", {120}, [year] {
                 const double t = static_cast<double>(days_of({year, 1, 1}) - days_of({2000, 1, 1})) / 36525;
                 const double a = 1.52371243 + 0.00000097 * t, e = 0.09336511 + 0.00009149 * t;
                 const double inclination = (1.85181869 - 0.00724757 * t) * kDegree_rad;
                 const double longitude = (-4.56813164 + 19140.29934243 * t) * kDegree_rad;
                 const double perihelion = (-23.91744784 + 0.45223625 * t) * kDegree_rad;
                 const double node = (49.71320984 - 0.26852431 * t) * kDegree_rad;
                 const double mean = longitude - perihelion;
                 double anomaly = mean;
                 for (int step = 0; step < 20; ++step)
                     anomaly -= (anomaly - e * std::sin(anomaly) - mean) / (1 - e * std::cos(anomaly));
                 const double x = a * (std::cos(anomaly) - e),
                              y = a * std::sqrt(1 - e * e) * std::sin(anomaly);
                 const auto about_z = [](double angle, Vec3d v) {
                     const double c = std::cos(angle), s = std::sin(angle);
                     return Vec3d{c * v.x - s * v.y, s * v.x + c * v.y, v.z};
                 };
                 const auto about_x = [](double angle, Vec3d v) {
                     const double c = std::cos(angle), s = std::sin(angle);
                     return Vec3d{v.x, c * v.y - s * v.z, s * v.y + c * v.z};
                 };
                 constexpr double kObliquity_deg = 23.43928;  // at J2000, as the elements' authors give it
                 const Vec3d ecliptic =
                     about_z(node, about_x(inclination, about_z(perihelion - node, {x, y, 0})));
                 const Vec3d truth = about_x(kObliquity_deg * kDegree_rad, ecliptic);
                 const Vec3d found = heliocentric(BodyId::kMars, from_tt({year, 1, 1}, 43200)).position_m;
                 return std::vector<Found>{{length(truth), angle_between_rad(truth, found) / kArcsecond_rad}};
             }});
    return group;
}

}  // namespace hilcam::extremes
