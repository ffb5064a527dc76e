#include "io/spice/earth_of_date.h"

#include "render/sky/earth_frames.h"

namespace hilcam {
namespace {

Mat3d j2000_from(EarthAxes axes, double et_s) {
    const EarthOfDate1976 earth = earth_of_date_1976(et_s);
    switch (axes) {
        case EarthAxes::kMeanEquator:
            return transposed(earth.mean_from_j2000);
        case EarthAxes::kTrueEquator:
            return transposed(earth.true_from_j2000);
        case EarthAxes::kMeanEcliptic: {
            const double c = std::cos(earth.mean_obliquity_rad), s = std::sin(earth.mean_obliquity_rad);
            return transposed(earth.mean_from_j2000) * Mat3d{{1, 0, 0}, {0, c, -s}, {0, s, c}};
        }
        case EarthAxes::kTeme:
            break;
    }
    const Vec3d z = earth.true_from_j2000.z, y = normalized(cross(z, earth.mean_from_j2000.x));
    return transposed(Mat3d{cross(y, z), y, z});
}

}  // namespace

FrameTurn earth_of_date(EarthAxes axes, double et_s) {
    // The fastest term that matters has a period of 5.5 days; a step of an hour leaves an error of 4e-4 of
    // it.
    constexpr double kStep_s = 3600;
    const Mat3d now = j2000_from(axes, et_s);
    return {now,
            rate_of(now, j2000_from(axes, et_s - kStep_s), j2000_from(axes, et_s + kStep_s), 2 * kStep_s)};
}

}  // namespace hilcam
