#include "io/orbits/two_body.h"

#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Stumpff's functions c0 to c3.
struct Stumpff {
    double c0, c1, c2, c3;
};

Stumpff stumpff(double x) {
    if (std::abs(x) < 1e-2) {
        // c_k = sum (-x)^n / (2 n + k)!; the rest is below 1e-16.
        double c2 = 0, c3 = 0, term = 0.5;
        for (int n = 0; n < 7; ++n) {
            c2 += term, c3 += term / (2 * n + 3);
            term *= -x / ((2 * n + 3) * (2 * n + 4));
        }
        return {1 - x * c2, 1 - x * c3, c2, c3};
    }
    const double root = std::sqrt(std::abs(x));
    const double c0 = x > 0 ? std::cos(root) : std::cosh(root);
    const double c1 = (x > 0 ? std::sin(root) : std::sinh(root)) / root;
    return {c0, c1, (1 - c0) / x, (1 - c1) / x};
}

}  // namespace

StateVector two_body_state(const StateVector& state, double gravity, double seconds) {
    const Vec3d r0 = state.position_m, v0 = state.velocity_m_s;
    const double distance = length(r0), radial = dot(r0, v0);
    const double alpha = 2 * gravity / distance - dot(v0, v0);  // gravity / a
    // Whole periods of an ellipse are removed.
    if (alpha > 0) seconds = std::remainder(seconds, kTurn_rad * gravity / (alpha * std::sqrt(alpha)));
    // Kepler's equation in s, a rising function: distance c1 s + radial c2 s^2 + gravity c3 s^3 = seconds.
    // Its derivative with respect to s is the distance at s.
    struct Point {
        double time, distance;
        Stumpff c;
    };
    const auto at = [&](double s) {
        const Stumpff c = stumpff(alpha * s * s);
        return Point{s * (distance * c.c1 + s * (radial * c.c2 + s * gravity * c.c3)),
                     distance * c.c0 + s * (radial * c.c1 + s * gravity * c.c2), c};
    };
    // A bracket, then Newton's steps inside it.
    double low = 0, high = 0, step = seconds / distance;
    if (step == 0) return state;
    for (int i = 0; i < 200; ++i, step *= 2) {
        const bool beyond = step > 0 ? at(step).time >= seconds : at(step).time <= seconds;
        if (beyond || !std::isfinite(at(step).time)) break;
    }
    (step > 0 ? high : low) = step;
    double s = step / 2;
    Point point = at(s);
    for (int i = 0; i < 200; ++i) {
        const double error = point.time - seconds;
        (error > 0 ? high : low) = s;
        double next = s - error / point.distance;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (next == s) break;
        const double moved = std::abs(next - s);
        s = next, point = at(s);
        if (moved <= 1e-16 * std::abs(s)) break;
    }
    // Lagrange's coefficients.
    const Stumpff& c = point.c;
    const double f = 1 - gravity * s * s * c.c2 / distance, g = seconds - gravity * s * s * s * c.c3;
    const double f_rate = -gravity * s * c.c1 / (distance * point.distance);
    const double g_rate = 1 - gravity * s * s * c.c2 / point.distance;
    return {f * r0 + g * v0, f_rate * r0 + g_rate * v0};
}

}  // namespace hilcam
