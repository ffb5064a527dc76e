#include "render/sky/own_bodies.h"

#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {

Mat3d fixed_from_icrf(const OwnBody& body, const StateVector& s, TimeTai time) {
    if (body.turn) return body.turn(time);
    if (body.synchronous) {
        const Vec3d x = -normalized(s.position_m);
        const Vec3d z = normalized(cross(s.position_m, s.velocity_m_s));
        return {x, cross(z, x), z};
    }
    const double ra = body.pole_right_ascension_rad, dec = body.pole_declination_rad;
    const Vec3d node{-std::sin(ra), std::cos(ra), 0};
    const Vec3d z{std::cos(dec) * std::cos(ra), std::cos(dec) * std::sin(ra), std::sin(dec)};
    const Vec3d across = cross(z, node);
    const double w = std::fmod(body.meridian_rad + body.rate_rad_s * seconds_since_j2000(time), kTurn_rad);
    const Vec3d x = std::cos(w) * node + std::sin(w) * across;
    return {x, cross(z, x), z};
}

double seconds_since_j2000(TimeTai time) {
    // J2000, 12 h TT, is 2000-01-01T11:59:27.816 TAI.
    static const TimeTai j2000 = parse_utc("2000-01-01T11:58:55.816Z");
    return static_cast<double>(time - j2000) * kSecondsPerNs;
}

void place_own_bodies(TimeTai time, const OwnBodies& own, std::optional<BodyId> home, Bodies& out) {
    HILCAM_CHECK(own.list.size() <= kMaxOwnBodies);
    for (std::size_t k = 0; k < own.list.size(); ++k) {
        const OwnBody& body = own.list[k];
        const Vec3d center_m = body.center ? out[*body.center].world_m : out.sun_world_m;
        // Light of the home's own satellites takes no time here, like that of the home.
        const bool at_home = body.center && body.center == home;
        const double light_s = at_home ? 0 : length(center_m) / kSpeedOfLight_m_s;
        const TimeTai then = time + -static_cast<std::int64_t>(light_s * 1e9);
        const StateVector s = body.orbit(then);
        out.body[kBodyCount + k] = {center_m + s.position_m, fixed_from_icrf(body, s, then),
                                    at_home ? out[*body.center].velocity_m_s : Vec3d{}, body.figure};
    }
}

}  // namespace hilcam
