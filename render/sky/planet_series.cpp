#include "render/sky/planet_series.h"

#include <array>
#include <cmath>
#include <span>

namespace hilcam {
namespace {

// Terms t^power (cosine cos(rate t) + sine sin(rate t)) of each coordinate, t in Julian millennia of TDB
// since J2000.
struct Term {
    int power;
    double rate_rad;
    double longitude_cos, longitude_sin;  // [1e-9 rad]
    double latitude_cos, latitude_sin;    // [1e-9 rad]
    double radius_cos, radius_sin;        // [1e-9 au]
};
constexpr double kAmplitudeUnit = 1e-9;
constexpr double kJulianMillennium_d = 365250;

#include "render/sky/planet_series_terms.inc"

std::span<const Term> terms_of(Planet planet) {
    switch (planet) {
        case Planet::kMercury:
            return kMercury;
        case Planet::kVenus:
            return kVenus;
        case Planet::kMars:
            return kMars;
        case Planet::kJupiter:
            return kJupiter;
        case Planet::kSaturn:
            return kSaturn;
        case Planet::kUranus:
            return kUranus;
        case Planet::kNeptune:
            return kNeptune;
    }
    return {};
}

struct Sum {
    double value = 0, rate = 0;
};
struct SphericalSums {
    Sum longitude, latitude, radius;
};

SphericalSums sum_of(std::span<const Term> terms, double t) {
    SphericalSums sums;
    constexpr int kPowers = 6;  // VSOP87 goes up to t^5
    std::array<double, kPowers> power{1}, power_rate{};
    for (std::size_t k = 1; k < kPowers; ++k) {
        power[k] = power[k - 1] * t;
        power_rate[k] = static_cast<double>(k) * power[k - 1];
    }
    for (const Term& term : terms) {
        const double cosine = std::cos(term.rate_rad * t), sine = std::sin(term.rate_rad * t);
        const double tk = power[static_cast<std::size_t>(term.power)],
                     tk_rate = power_rate[static_cast<std::size_t>(term.power)];
        const double value_cos = tk * cosine, value_sin = tk * sine;
        const double rate_cos = tk_rate * cosine - term.rate_rad * value_sin,
                     rate_sin = tk_rate * sine + term.rate_rad * value_cos;
        const auto add = [&](Sum& sum, double a, double b) {
            sum.value += a * value_cos + b * value_sin;
            sum.rate += a * rate_cos + b * rate_sin;
        };
        add(sums.longitude, term.longitude_cos, term.longitude_sin);
        add(sums.latitude, term.latitude_cos, term.latitude_sin);
        add(sums.radius, term.radius_cos, term.radius_sin);
    }
    return sums;
}

// Rotates from VSOP87's ecliptic and equinox (dynamical, J2000) to the FK5's axes, which equal the ICRF's to
// 0.02 arcsec. Bretagnon & Francou, vsop87.doc (CDS VI/81), "Reference system".
constexpr Mat3d kEquatorialFromEcliptic{{1, 0.000000440360, -0.000000190919},
                                        {-0.000000479966, 0.917482137087, -0.397776982902},
                                        {0, 0.397776982902, 0.917482137087}};

}  // namespace

PlanetState planet_by_series(Planet planet, double tdb_days) {
    const SphericalSums sums = sum_of(terms_of(planet), tdb_days / kJulianMillennium_d);
    constexpr double kPerDay = kAmplitudeUnit / kJulianMillennium_d;
    const double l = sums.longitude.value * kAmplitudeUnit, l_rate = sums.longitude.rate * kPerDay,
                 b = sums.latitude.value * kAmplitudeUnit, b_rate = sums.latitude.rate * kPerDay,
                 r = sums.radius.value * kAmplitudeUnit, r_rate = sums.radius.rate * kPerDay;
    const double cos_l = std::cos(l), sin_l = std::sin(l), cos_b = std::cos(b), sin_b = std::sin(b);
    const Vec3d outward{cos_b * cos_l, cos_b * sin_l, sin_b}, east{-sin_l, cos_l, 0},
        north{-sin_b * cos_l, -sin_b * sin_l, cos_b};
    const Vec3d velocity = r_rate * outward + (r * cos_b * l_rate) * east + (r * b_rate) * north;
    return {kEquatorialFromEcliptic * (r * outward), kEquatorialFromEcliptic * velocity};
}

}  // namespace hilcam
