#include "render/sky/saturn_rings.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/table.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// C from 74 658, B from 92 000, Cassini's division from 117 580, A from 122 170 to 136 775 km; Encke's
// division is 325 km wide around 133 589 km.
const Table& depths() {
    static const Table table{
        {74658,  74700,  80000,  87000,  91990,  92000,  99000,  104000, 110000, 117500, 117580, 117950,
         118100, 120000, 122150, 122170, 124500, 127000, 133420, 133430, 133750, 133760, 136760, 136775},
        {0,    0.05, 0.09, 0.11, 0.18, 0.9, 1.1,  1.7, 2.3, 1.9,  0.02, 0.02,
         0.08, 0.09, 0.10, 0.9,  0.7,  0.5, 0.55, 0.0, 0.0, 0.55, 0.5,  0}};
    return table;
}

}  // namespace

SaturnRings::SaturnRings(const SpectralGrid& grid)
    : color_(grid.average({{0.40, 0.55, 0.65, 2.5}, {0.67, 1, 1.05, 1.05}, {}})) {}

double SaturnRings::depth(double radius_m) {
    const double km = radius_m * 1e-3;
    return km <= depths().x.front() || km >= depths().x.back() ? 0 : depths().at(km);
}

double SaturnRings::albedo(double radius_m) {
    const double km = radius_m * 1e-3;
    return km < 92000 ? 0.2 : km < 117580 ? 0.55 : km < 122170 ? 0.3 : 0.5;
}

double SaturnRings::phase_function(double phase_rad) {
    constexpr double kPower = 3.09;
    // The integral of (pi - a)^n sin a / 2 over 0..pi, by the midpoint rule, computed once.
    static const double whole = [] {
        constexpr int kSteps = 20000;
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double a = kPi * (i + 0.5) / kSteps;
            sum += 0.5 * std::pow(kPi - a, kPower) * std::sin(a) * kPi / kSteps;
        }
        return sum;
    }();
    return std::pow(std::max(0.0, kPi - phase_rad), kPower) / whole;
}

SaturnRings::Met SaturnRings::meet(Vec3d origin_m, Vec3d dir) {
    if (dir.z == 0) return {};
    const double distance = -origin_m.z / dir.z;
    if (!(distance > 0)) return {};
    const Vec3d point_m{origin_m.x + distance * dir.x, origin_m.y + distance * dir.y, 0};
    const double radius2 = point_m.x * point_m.x + point_m.y * point_m.y;
    if (radius2 > kOuter_m * kOuter_m || radius2 < kInner_m * kInner_m) return {};
    return {distance, point_m};
}

double SaturnRings::transmittance(Vec3d origin_m, Vec3d dir) {
    const Met met = meet(origin_m, dir);
    if (met.distance < 0) return 1;
    const double mu = std::abs(dir.z) / length(dir);
    return std::exp(-depth(std::hypot(met.point_m.x, met.point_m.y)) / std::max(1e-6, mu));
}

double SaturnRings::brightness(double phase_rad) {
    return 1.3 * (1 + 0.35 * std::exp(-2.25 * phase_rad / kDegree_rad));
}

double SaturnRings::radiance_sr(double radius_m, Vec3d to_viewer, Vec3d to_sun) {
    const double mu = std::max(1e-6, std::abs(to_viewer.z)), mu0 = std::max(1e-6, std::abs(to_sun.z));
    const double phase = std::acos(std::clamp(dot(to_viewer, to_sun), -1.0, 1.0));
    const double tau = depth(radius_m);
    double share = 0;
    if (to_viewer.z * to_sun.z > 0)  // its lit face
        share = mu0 / (mu0 + mu) * -std::expm1(-tau / mu0 - tau / mu);
    else if (std::abs(mu0 - mu) > 1e-4 * mu)
        share = mu0 / (mu0 - mu) * (std::exp(-tau / mu0) - std::exp(-tau / mu));
    else
        share = tau / mu * std::exp(-tau / mu);
    return albedo(radius_m) * share * phase_function(phase) * brightness(phase) / (4 * kPi);
}

SaturnRings::Look SaturnRings::look(Vec3d point_m, double footprint_m, Vec3d to_viewer, Vec3d to_sun) const {
    const double mu = std::max(1e-6, std::abs(to_viewer.z));
    const double radius_m = std::hypot(point_m.x, point_m.y);
    // The part of the footprint on the rings: they have their own light, whatever its width.
    const double from_m = std::clamp(radius_m - 0.5 * footprint_m, kInner_m, radius_m),
                 to_m = std::clamp(radius_m + 0.5 * footprint_m, radius_m, kOuter_m);
    constexpr int kParts = 5;
    double scattered = 0, passed = 0, area = 0;
    for (int i = 0; i < kParts; ++i) {
        const double here_m = from_m + (i + 0.5) / kParts * (to_m - from_m);
        passed += here_m * std::exp(-depth(here_m) / mu);
        scattered += here_m * radiance_sr(here_m, to_viewer, to_sun);
        area += here_m;
    }
    return {static_cast<float>(scattered / area) * color_, static_cast<float>(passed / area)};
}

}  // namespace hilcam
