#include "render/earth/sea.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr float kPiOfWaves = static_cast<float>(kPi);
constexpr float kIndex = 1.34f;

}  // namespace

float water_fresnel(float cosine) {
    const float c = std::clamp(cosine, 0.0f, 1.0f);
    const float t = std::sqrt(1 - (1 - c * c) / (kIndex * kIndex));
    const float s = (c - kIndex * t) / (c + kIndex * t), p = (kIndex * c - t) / (kIndex * c + t);
    return 0.5f * (s * s + p * p);
}

Sea::Sea(double wind_m_s, const SpectralGrid& grid)
    : variance_(0.003 + 0.00512 * wind_m_s),
      foam_(std::min(1.0, 2.95e-6 * std::pow(wind_m_s, 3.52))),
      sigma_(static_cast<float>(std::sqrt(0.5 * variance_))) {
    const Spectrum water = grid.average({{0.35, 0.40, 0.45, 0.50, 0.55, 0.60, 0.65, 0.70, 0.75, 1.05},
                                         {0.045, 0.042, 0.035, 0.022, 0.009, 0.003, 0.002, 0.001, 0, 0},
                                         {}});
    constexpr float kFoam = 0.22f;
    // A flat surface mirrors 0.066 of a uniform sky (Fresnel's law over all directions, n = 1.34).
    constexpr float kMirrored = 0.066f;
    const auto foam = static_cast<float>(foam_);
    for (int b = 0; b < grid.size(); ++b) {
        diffuse_[b] = (1 - foam) * water[b] + foam * kFoam;
        albedo_[b] = diffuse_[b] + (1 - foam) * kMirrored;
    }
}

// 1 / (1 + Lambda): Smith 1967, eq. 24, slopes of one axis.
float Sea::shadowing(float mu) const {
    const float sine = std::sqrt(std::max(1e-12f, 1 - mu * mu));
    const float v = mu / (sine * sigma_ * 1.41421356f);
    if (v > 3) return 1;
    const float lambda =
        0.5f * (std::exp(-v * v) / (std::max(v, 1e-4f) * std::sqrt(kPiOfWaves)) - std::erfc(v));
    return 1 / (1 + std::max(0.0f, lambda));
}

float Sea::glint_sr(float mu0, float mu, float cos_phase) const {
    if (!(mu0 > 0) || !(mu > 0)) return 0;
    // The facet that mirrors one direction into the other: its normal h halves the angle.
    const float half = std::sqrt(std::max(1e-6f, 0.5f * (1 + cos_phase)));  // cos of the angle of incidence
    const float nh = std::min(1.0f, (mu0 + mu) / (2 * half));
    const float n2 = nh * nh;
    const auto variance = static_cast<float>(variance_);
    const float slope2 = (1 - n2) / n2;
    const float density = std::exp(-slope2 / variance) / (kPiOfWaves * variance);
    // Cox & Munk 1954, eq. 9, as radiance: F P / (4 mu cos^4 beta); P includes each facet's own cosine.
    return (1 - static_cast<float>(foam_)) * water_fresnel(half) * density * shadowing(mu0) * shadowing(mu) /
           (4 * std::max(mu, 1e-3f) * n2 * n2);
}

float Sea::sky_mirrored(float mu) const {
    // At grazing angles the visible facets lean towards the viewer by about the rms of the slopes.
    const float seen =
        std::sqrt(std::max(0.0f, mu) * std::max(0.0f, mu) + sigma_ * sigma_) / std::sqrt(1 + sigma_ * sigma_);
    return (1 - static_cast<float>(foam_)) * water_fresnel(seen);
}

}  // namespace hilcam
