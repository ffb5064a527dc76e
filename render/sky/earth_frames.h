#pragma once
// The Earth's other axes, in which orbits are given.

#include "render/sky/bodies.h"

namespace hilcam {

// The Earth's rotation rate [rad/s] about the axis of ITRF: that of the Earth rotation angle (Capitaine,
// Guinot & McCarthy 2000; IERS Conventions 2010, eq. 5.15).
inline constexpr double kEarthRate_rad_s = 7.292115146706979e-5;

// Returns the rotation from true equator and mean equinox of date, SGP4's axes, to ICRF: about the pole by
// Greenwich mean sidereal time of 1982 to the Earth's axes (AIAA 2006-6753, appendix C), then by
// earth_rotated_from_icrf(). UT1 - UTC and its error cancel, because both rotations contain it. Compared with
// the path through IAU 1976/1980 the axes differ by some tens of mas: at most a metre in low orbits, where
// SGP4 is good to a kilometre.
Mat3d icrf_from_teme(TimeTai time, const EarthOrientation& measured);
// Returns the rotation from mean equator and equinox of J2000 to ICRF: the frame bias of IAU 2006 (ERFA
// eraBp06), 23 mas.
Mat3d icrf_from_eme2000();

// The Earth's mean and true equator and equinox of date by the IAU's precession of 1976 and nutation of 1980
// (ERFA's eraPmat76, eraNutm80, eraObl80), like SPICE. et_s: TDB seconds since J2000; TT differs by 2 ms. Any
// thread.
struct EarthOfDate1976 {
    Mat3d mean_from_j2000, true_from_j2000;
    double mean_obliquity_rad;
};
EarthOfDate1976 earth_of_date_1976(double et_s);

// The same at an instant of TAI, to ICRF by way of EME2000. Compared with IAU 2006/2000A the axes differ by
// 0.1 arcsec in 2026 (the pole corrections that the IERS publishes): 4 m in low orbits.
Mat3d icrf_from_mean_of_date(TimeTai time);
Mat3d icrf_from_true_of_date(TimeTai time);

// Returns the Earth's rotation in ICRF axes: about the celestial intermediate pole, which differs slightly
// from ITRF's z.
Vec3d earth_rate_rad_s(TimeTai time, const EarthOrientation& measured);

}  // namespace hilcam
