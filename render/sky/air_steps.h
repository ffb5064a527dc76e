#pragma once
// Divides a ray through a ball of air into pieces, and computes what one piece adds to the light along it.

#include <algorithm>
#include <cmath>

#include "render/vocabulary/spectrum.h"

namespace hilcam {

// A piece of a ray: its middle and its length.
struct AirStep {
    double distance_m, length_m;
};

// Calls step(AirStep) from begin to end; pieces are denser towards the lowest point, cubically. low_m:
// distance to the ray's lowest point, which may be outside. count: pairs of pieces on each side of it.
template <class Action>
void for_each_air_step(double low_m, double from_m, double end_m, int count, const Action& action) {
    // Each pair has two points of Gauss-Legendre quadrature, half of it each.
    constexpr double kGauss = 0.57735026918962576;
    const double low = std::clamp(low_m, from_m, end_m);
    const double before = low - from_m, after = end_m - low;
    if (before > 0)
        for (int i = count - 1; i >= 0; --i) {
            const double a = static_cast<double>(i) / count, b = static_cast<double>(i + 1) / count;
            const double near = before * a * a * a, half = 0.5 * (before * b * b * b - near);
            action(AirStep{low - near - half * (1 + kGauss), half});
            action(AirStep{low - near - half * (1 - kGauss), half});
        }
    if (after > 0)
        for (int i = 0; i < count; ++i) {
            const double a = static_cast<double>(i) / count, b = static_cast<double>(i + 1) / count;
            const double near = after * a * a * a, half = 0.5 * (after * b * b * b - near);
            action(AirStep{low + near + half * (1 - kGauss), half});
            action(AirStep{low + near + half * (1 + kGauss), half});
        }
}

inline Spectrum exp_of_minus(const Spectrum& depth) {
    Spectrum out;
    for (int b = 0; b < kMaxBins; ++b) out[b] = std::exp(-depth[b]);
    return out;
}

// A piece of a ray with uniform sources: its transmittance, and the effective length of its sources, which
// takes extinction inside the piece into account, (1 - e^-x) / x.
struct AirPiece {
    Spectrum passed, length_m;
    AirPiece(const Spectrum& extinction, double piece_m) {
        const auto whole_m = static_cast<float>(piece_m);
        passed = exp_of_minus(whole_m * extinction);
        for (int b = 0; b < kMaxBins; ++b) {
            const float x = whole_m * extinction[b];
            length_m[b] = whole_m * (x > 1e-4f ? (1 - passed[b]) / x : 1 - 0.5f * x);
        }
    }
};

}  // namespace hilcam
