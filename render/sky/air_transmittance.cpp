#include "render/sky/air_transmittance.h"

#include <algorithm>
#include <cmath>

#include "render/sky/air_steps.h"

namespace hilcam {
namespace {

constexpr double kGround_m = AirBall::kGround_m, kAirTop_m = AirBall::kTop_m;
constexpr double kSunAngularRadius_rad = kSunRadius_m / kAstronomicalUnit_m;

// Directions to space are gridded by the distance to the top, between its least and greatest value (Bruneton
// & Neyret, EGSR 2008): smooth at the horizon.
double direction_coordinate(double r, double mu) {
    const double nearest = kAirTop_m - r, rho = std::sqrt(std::max(0.0, r * r - kGround_m * kGround_m));
    const double farthest = rho + std::sqrt(kAirTop_m * kAirTop_m - kGround_m * kGround_m);
    return farthest > nearest ? (AirBall::to_sphere_far(r, mu, kAirTop_m) - nearest) / (farthest - nearest)
                              : 0;
}
double direction_at(double r, double u) {
    const double nearest = kAirTop_m - r, rho = std::sqrt(std::max(0.0, r * r - kGround_m * kGround_m));
    const double farthest = rho + std::sqrt(kAirTop_m * kAirTop_m - kGround_m * kGround_m);
    const double d = nearest + u * (farthest - nearest);
    return d > 0 ? std::clamp((kAirTop_m * kAirTop_m - r * r - d * d) / (2 * r * d), -1.0, 1.0) : 1.0;
}

}  // namespace

double AirBall::to_sphere_far(double r, double mu, double radius) {
    return -r * mu + std::sqrt(std::max(0.0, r * r * (mu * mu - 1) + radius * radius));
}
double AirBall::to_ground(double r, double mu) {
    return -r * mu - std::sqrt(std::max(0.0, r * r * (mu * mu - 1) + kGround_m * kGround_m));
}
double AirBall::height_coordinate(double r) {
    return std::sqrt(std::clamp((r - kGround_m) / AirPhysics::kTop_m, 0.0, 1.0));
}
double AirBall::sun_coordinate(double mu_s) {
    const double s = std::clamp(mu_s, -1.0, 1.0);
    return 0.5 + 0.5 * std::copysign(std::sqrt(std::abs(s)), s);
}
double AirBall::sun_at(double u) { return std::copysign((2 * u - 1) * (2 * u - 1), 2 * u - 1); }

void AirTransmittance::fill(const AirPhysics& air) {
    for (int y = 0; y < table_.height(); ++y)
        for (int x = 0; x < table_.width(); ++x) {
            const double r = AirBall::height_at(static_cast<double>(y) / (table_.height() - 1));
            const double mu = direction_at(r, static_cast<double>(x) / (table_.width() - 1));
            Spectrum depth;
            for_each_air_step(-r * mu, 0, AirBall::to_sphere_far(r, mu, kAirTop_m), 60, [&](AirStep step) {
                const double d = step.distance_m;
                const double height = std::sqrt(r * r + d * d + 2 * r * mu * d) - kGround_m;
                depth += static_cast<float>(step.length_m) * air.at(height).extinction;
            });
            table_.at(x, y) = exp_of_minus(depth);
        }
}

Spectrum AirTransmittance::to_space(double r, double mu) const {
    if (r >= kAirTop_m) r = kAirTop_m;
    return table_(direction_coordinate(r, mu), AirBall::height_coordinate(r));
}
Spectrum AirTransmittance::to_sun(double r, double mu_s) const {
    if (r > kAirTop_m) {
        // From outside: where the ray enters the air, if it does.
        const double inside = r * r * (mu_s * mu_s - 1) + kAirTop_m * kAirTop_m;
        Spectrum clear;
        clear.bin.fill(1);
        if (mu_s >= 0 || inside <= 0) return clear;
        const double d = -r * mu_s - std::sqrt(inside);
        const double mu_entry = std::clamp((r * mu_s + d) / kAirTop_m, -1.0, 1.0);
        return to_sun(kAirTop_m, mu_entry);
    }
    const double horizon = std::max(r, kGround_m);
    const double sine_h = kGround_m / horizon;
    const double cos_h = -std::sqrt(std::max(0.0, 1 - sine_h * sine_h));
    // mu - mu_horizon is about the sine of the angle above the horizon, times sine_h.
    const double above = (mu_s - cos_h) / (std::max(1e-3, sine_h) * kSunAngularRadius_rad);
    if (above <= -1) return {};
    const double x = std::clamp(0.5 * (above + 1), 0.0, 1.0);
    return static_cast<float>(x * x * (3 - 2 * x)) * to_space(horizon, std::max(mu_s, cos_h));
}

}  // namespace hilcam
