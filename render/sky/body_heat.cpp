#include "render/sky/body_heat.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Returns the integral of the radiance over a unit sphere's visible disk, seen along z: over chords along y,
// and along each of them by longitude.
Spectrum disk_of(const BodyHeat& heat, double phase_rad) {
    constexpr int kRows = 24, kColumns = 96;
    Spectrum sum;
    for (int j = 0; j < kRows; ++j) {
        const double y = std::sin(0.5 * kPi * (j + 0.5) / kRows);
        const double half = std::sqrt(1 - y * y), strip = 0.5 * kPi / kRows * half;
        for (int i = 0; i < kColumns; ++i) {
            const double longitude = kPi * ((i + 0.5) / kColumns - 0.5);
            const double area = strip * kPi / kColumns * half * std::cos(longitude);
            sum += static_cast<float>(2 * area) *
                   heat.radiance(static_cast<float>(half * std::cos(longitude - phase_rad)));
        }
    }
    return sum;
}

}  // namespace

BodyHeatConfig default_heat(BodyId id) {
    switch (id) {
        case BodyId::kMercury:
            return {700, 100, 0.95};
        case BodyId::kVenus:
            return {227, 227, 1};
        case BodyId::kEarth:
            return {254, 254, 1};
        case BodyId::kMoon:
            return {385, 95, 0.95};
        case BodyId::kMars:
            return {280, 180, 0.95};
        case BodyId::kJupiter:
            return {124.4, 124.4, 1};
        case BodyId::kSaturn:
            return {95.0, 95.0, 1};
        case BodyId::kUranus:
            return {59.1, 59.1, 1};
        case BodyId::kNeptune:
            return {59.3, 59.3, 1};
    }
    return {};  // a body that the scenario adds
}

Fields fields(BodyHeatConfig& c) {
    return {
        number("noon_k", c.noon_k, 1, {0, 6000}, "temperature below the Sun"),
        number("night_k", c.night_k, 1, {0, 6000}, "temperature of the night side"),
        number("emissivity", c.emissivity, 1, {0, 1}, "emissivity beyond 2.5 um"),
    };
}

void validate(const BodyHeatConfig& c) {
    if (c.night_k > c.noon_k)
        throw refused_key("night_k", plain(c.night_k), "at most noon_k, which is " + plain(c.noon_k));
}

BodyHeat::BodyHeat(const BodyHeatConfig& c, const SpectralGrid& grid) : solar_bins_(grid.solar_bins()) {
    if (!grid.has_thermal()) return;
    const double noon4 = std::pow(c.noon_k, 4), night4 = std::pow(c.night_k, 4);
    const auto emissivity = static_cast<float>(c.emissivity);
    for (std::size_t i = 0; i <= kSteps; ++i) {
        const double mu0 = square(static_cast<double>(i) / kSteps);
        Spectrum sent = emissivity * planck_w_m2_sr_um(grid, std::pow(night4 + (noon4 - night4) * mu0, 0.25));
        for (int b = 0; b < grid.solar_bins(); ++b) sent[b] = 0;
        by_root_.push_back(sent);
    }
    for (int b = grid.solar_bins(); b < grid.size(); ++b) reflected_[b] = 1 - emissivity;
    for (int degree = 0; degree <= 181; ++degree)
        disk_by_degree_.push_back(disk_of(*this, std::min(degree, 180) * kDegree_rad));
}

Spectrum BodyHeat::radiance(float mu0) const {
    const float x = std::sqrt(std::clamp(mu0, 0.0f, 1.0f)) * kSteps;
    const auto i = std::min(static_cast<std::size_t>(x), kSteps - 1);
    const float t = x - static_cast<float>(i);
    return (1 - t) * by_root_[i] + t * by_root_[i + 1];
}

Spectrum BodyHeat::disk_w_m2_um(double phase_rad) const {
    const double degrees = std::clamp(phase_rad / kDegree_rad, 0.0, 180.0);
    const auto i = static_cast<std::size_t>(degrees);
    const auto t = static_cast<float>(degrees - static_cast<double>(i));
    return (1 - t) * disk_by_degree_[i] + t * disk_by_degree_[i + 1];
}

}  // namespace hilcam
