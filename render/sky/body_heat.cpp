#include "render/sky/body_heat.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "render/sky/regolith.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kLeastEmissivity = 0.5;  // a regolith that emits less is no measured one

Spectrum emitted(const BodyHeatConfig& c, const SpectralGrid& grid, double kelvin) {
    Spectrum sent = static_cast<float>(c.emissivity) * planck_w_m2_sr_um(grid, kelvin);
    for (int b = 0; b < grid.solar_bins(); ++b) sent[b] = 0;
    return sent;
}

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
            const double hour_rad = longitude - phase_rad;
            BodyHeat::Place place{static_cast<float>(half * std::cos(hour_rad)), static_cast<float>(y),
                                  static_cast<float>(hour_rad)};
            sum += static_cast<float>(area) * heat.radiance(place);
            place.hour_rad = -place.hour_rad;
            sum += static_cast<float>(area) * heat.radiance(place);
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
            return {385, 95, 0.95, BodyHeatConfig::Model::kRegolith, 0.12, true};
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
        choice("model", c.model, {"grey", "regolith"},
               "grey: in equilibrium with the sunlight of now; regolith: the Moon's ground with the heat "
               "that it keeps"),
        number("noon_k", c.noon_k, 1, {0, 6000}, "grey: temperature below the Sun"),
        number("night_k", c.night_k, 1, {0, 6000}, "grey: temperature of the night side"),
        number("albedo", c.albedo, 1, {0, 1},
               "regolith: share of sunlight from the zenith that is reflected"),
        number("emissivity", c.emissivity, 1, {0, 1}, "emissivity beyond 2.5 um"),
    };
}

void validate(const BodyHeatConfig& c) {
    if (c.night_k > c.noon_k)
        throw refused_key("night_k", plain(c.night_k), "at most noon_k, which is " + plain(c.noon_k));
    if (c.model != BodyHeatConfig::Model::kRegolith) return;
    if (!c.has_regolith) throw refused_key("model", "regolith", "grey; regolith is the ground of the Moon");
    if (c.emissivity < kLeastEmissivity)
        throw refused_key("emissivity", plain(c.emissivity),
                          "at least " + plain(kLeastEmissivity) + " for regolith");
}

BodyHeat::BodyHeat(const BodyHeatConfig& c, const SpectralGrid& grid) : solar_bins_(grid.solar_bins()) {
    if (!grid.has_thermal()) return;
    c.model == BodyHeatConfig::Model::kGrey ? make_grey(c, grid) : make_regolith(c, grid);
    for (const Spectrum& sent : by_root_.empty() ? by_place_ : by_root_)
        for (int b = 0; b < grid.size(); ++b) most_[b] = std::max(most_[b], sent[b]);
    for (int b = grid.solar_bins(); b < grid.size(); ++b)
        reflected_[b] = 1 - static_cast<float>(c.emissivity);
    for (int degree = 0; degree <= 181; ++degree)
        disk_by_degree_.push_back(disk_of(*this, std::min(degree, 180) * kDegree_rad));
}

void BodyHeat::make_grey(const BodyHeatConfig& c, const SpectralGrid& grid) {
    const double noon4 = std::pow(c.noon_k, 4), night4 = std::pow(c.night_k, 4);
    for (std::size_t i = 0; i <= kSteps; ++i) {
        const double mu0 = square(static_cast<double>(i) / kSteps);
        by_root_.push_back(emitted(c, grid, std::pow(night4 + (noon4 - night4) * mu0, 0.25)));
    }
}

void BodyHeat::make_regolith(const BodyHeatConfig& c, const SpectralGrid& grid) {
    by_place_.resize(kLatitudes * kHours);
    tbb::parallel_for(std::size_t{0}, kLatitudes, [&](std::size_t i) {
        const Regolith ground{.albedo = c.albedo, .emissivity = c.emissivity};
        const double latitude_rad = 0.5 * kPi * static_cast<double>(i) / (kLatitudes - 1);
        const std::vector<double> day_k = regolith_day_k(ground, latitude_rad, kHours);
        for (std::size_t k = 0; k < kHours; ++k) by_place_[i * kHours + k] = emitted(c, grid, day_k[k]);
    });
}

Spectrum BodyHeat::radiance(const Place& place) const {
    if (!by_place_.empty()) return regolith(place);
    const float x = std::sqrt(std::clamp(place.mu0, 0.0f, 1.0f)) * kSteps;
    const auto i = std::min(static_cast<std::size_t>(x), kSteps - 1);
    const float t = x - static_cast<float>(i);
    return (1 - t) * by_root_[i] + t * by_root_[i + 1];
}

Spectrum BodyHeat::regolith(const Place& place) const {
    const float latitude =
        std::asin(std::min(1.0f, std::abs(place.sine_latitude))) / static_cast<float>(0.5 * kPi);
    const float x = latitude * (kLatitudes - 1);
    const auto i = std::min(static_cast<std::size_t>(x), kLatitudes - 2);
    const float t = x - static_cast<float>(i);
    const float turns = place.hour_rad / static_cast<float>(2 * kPi);
    const float y = (turns - std::floor(turns)) * kHours;
    const auto k = std::min(static_cast<std::size_t>(y), kHours - 1);
    const float u = y - static_cast<float>(k);
    const Spectrum* const south = &by_place_[i * kHours];
    const Spectrum* const north = south + kHours;
    const std::size_t next = (k + 1) % kHours;
    return (1 - t) * ((1 - u) * south[k] + u * south[next]) + t * ((1 - u) * north[k] + u * north[next]);
}

Spectrum BodyHeat::disk_w_m2_um(double phase_rad) const {
    const double degrees = std::clamp(phase_rad / kDegree_rad, 0.0, 180.0);
    const auto i = static_cast<std::size_t>(degrees);
    const auto t = static_cast<float>(degrees - static_cast<double>(i));
    return (1 - t) * disk_by_degree_[i] + t * disk_by_degree_[i + 1];
}

}  // namespace hilcam
