#include "emulator/motion/kepler_orbit.h"

#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Finds the root of a rising function in [low, high] with Newton steps, or bisection where a step would leave
// the bracket.
template <class F>
double rising_root(F&& value_and_slope, double low, double high) {
    double x = 0.5 * (low + high);
    for (int i = 0; i < 100; ++i) {
        const auto [value, slope] = value_and_slope(x);
        (value > 0 ? high : low) = x;
        double next = x - value / slope;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (std::abs(next - x) <= 1e-16 * (1 + std::abs(x))) return next;
        x = next;
    }
    return x;
}

struct ValueSlope {
    double value, slope;
};

}  // namespace

double eccentric_anomaly(double m, double e) {
    if (e < 1) {
        // E is within e of M.
        const double whole = 2 * kPi * std::round(m / (2 * kPi));
        const double part = m - whole;
        return whole + rising_root(
                           [&](double x) {
                               return ValueSlope{x - e * std::sin(x) - part, 1 - e * std::cos(x)};
                           },
                           part - e, part + e);
    }
    // e sinh F - F >= (e - 1) F and >= e F^3 / 6: either bounds F from above.
    const double size = std::abs(m);
    const double most = std::min(size / (e - 1), std::cbrt(6 * size / e)) + 1e-300;
    const double root = rising_root(
        [&](double x) {
            return ValueSlope{e * std::sinh(x) - x - size, e * std::cosh(x) - 1};
        },
        0, most);
    return std::copysign(root, m);
}

double mean_anomaly(double true_anomaly_rad, double e) {
    const double half = std::tan(0.5 * true_anomaly_rad);
    if (e < 1) {
        const double turns = 2 * kPi * std::round(true_anomaly_rad / (2 * kPi));
        const double eccentric = 2 * std::atan(std::sqrt((1 - e) / (1 + e)) * half);
        return turns + eccentric - e * std::sin(eccentric);
    }
    const double argument = std::sqrt((e - 1) / (e + 1)) * half;
    if (!(std::abs(argument) < 1))
        throw refused("true anomaly", plain(true_anomaly_rad / kDegree_rad) + " deg",
                      "inside the hyperbola's asymptotes");
    const double f = 2 * std::atanh(argument);
    return e * std::sinh(f) - f;
}

KeplerOrbit::KeplerOrbit(const KeplerElements& k, double gravity_m3_s2)
    : elements_(k), gravity_m3_s2_(gravity_m3_s2) {
    if (!(k.semi_major_axis_m * (1 - k.eccentricity) > 0) || !(k.eccentricity >= 0))
        throw InputError("found a semi-major axis of " + plain(k.semi_major_axis_m / 1000) +
                         " km with eccentricity " + plain(k.eccentricity) +
                         "; accepted: above 0 with 0 to below 1, below 0 with above 1");
    HILCAM_CHECK(gravity_m3_s2 > 0);
    const double a = std::abs(k.semi_major_axis_m);
    mean_motion_rad_s_ = std::sqrt(gravity_m3_s2 / a) / a;
    const double ci = std::cos(k.inclination_rad), si = std::sin(k.inclination_rad);
    const double cn = std::cos(k.node_rad), sn = std::sin(k.node_rad);
    const double cw = std::cos(k.periapsis_rad), sw = std::sin(k.periapsis_rad);
    periapsis_dir_ = {cn * cw - sn * sw * ci, sn * cw + cn * sw * ci, sw * si};
    across_dir_ = {-cn * sw - sn * cw * ci, -sn * sw + cn * cw * ci, cw * si};
}

StateVector KeplerOrbit::at(double seconds) const {
    const double e = elements_.eccentricity, a = elements_.semi_major_axis_m;
    const double m = elements_.mean_anomaly_rad + mean_motion_rad_s_ * seconds;
    const double anomaly = eccentric_anomaly(m, e);
    // Components along the periapsis and across it, from the centre; a < 0 and hyperbolic functions for
    // hyperbolas.
    const bool closed = e < 1;
    const double c = closed ? std::cos(anomaly) : std::cosh(anomaly);
    const double s = closed ? std::sin(anomaly) : std::sinh(anomaly);
    const double b = std::abs(a) * std::sqrt(std::abs(1 - e * e));
    const double rate = mean_motion_rad_s_ / std::abs(1 - e * c);  // rate of the anomaly
    const double x = a * (c - e), y = b * s;
    const double x_rate = -std::abs(a) * s * rate, y_rate = b * c * rate;
    return {x * periapsis_dir_ + y * across_dir_, x_rate * periapsis_dir_ + y_rate * across_dir_};
}

}  // namespace hilcam
