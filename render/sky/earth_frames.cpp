#include "render/sky/earth_frames.h"

#include <erfa.h>

#include <cmath>

namespace hilcam {

Mat3d icrf_from_teme(TimeTai time, const EarthOrientation& measured) {
    const JulianDate ut1 = julian_ut1(time, measured.ut1_minus_utc_s);
    const double angle = eraGmst82(ut1.day, ut1.fraction), c = std::cos(angle), s = std::sin(angle);
    return transposed(earth_rotated_from_icrf(time, measured)) * Mat3d{{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
}

Mat3d icrf_from_eme2000() {
    double bias[3][3], precession[3][3], both[3][3];
    eraBp06(2451545.0, 0.0, bias, precession, both);
    return transposed(Mat3d{{bias[0][0], bias[0][1], bias[0][2]},
                            {bias[1][0], bias[1][1], bias[1][2]},
                            {bias[2][0], bias[2][1], bias[2][2]}});
}

EarthOfDate1976 earth_of_date_1976(double et_s) {
    const double days = et_s / 86400;
    double mean[3][3], nutation[3][3];
    eraPmat76(2451545.0, days, mean);
    eraNutm80(2451545.0, days, nutation);
    const auto matrix = [](const double(&m)[3][3]) {
        return Mat3d{{m[0][0], m[0][1], m[0][2]}, {m[1][0], m[1][1], m[1][2]}, {m[2][0], m[2][1], m[2][2]}};
    };
    const Mat3d mean_from_j2000 = matrix(mean);
    return {mean_from_j2000, matrix(nutation) * mean_from_j2000, eraObl80(2451545.0, days)};
}

namespace {

// TT is used for TDB: 2 ms of precession.
EarthOfDate1976 earth_at(TimeTai time) {
    const JulianDate tt = julian_tt(time);
    return earth_of_date_1976(86400 * ((tt.day - 2451545.0) + tt.fraction));
}

}  // namespace

Mat3d icrf_from_mean_of_date(TimeTai time) {
    return icrf_from_eme2000() * transposed(earth_at(time).mean_from_j2000);
}

Mat3d icrf_from_true_of_date(TimeTai time) {
    return icrf_from_eme2000() * transposed(earth_at(time).true_from_j2000);
}

Vec3d earth_rate_rad_s(TimeTai time, const EarthOrientation& measured) {
    return kEarthRate_rad_s * earth_rotated_from_icrf(time, measured).z;
}

}  // namespace hilcam
