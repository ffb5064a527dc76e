#include "render/sky/body_light.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kSunMagnitudeV = -26.76;
constexpr double kSunColorBv = 0.653;
// Mercury ... Neptune; the Earth's is not used.
constexpr std::array<double, kBodyCount> kColorBv = {0.93, 0.82, 0.0, 0.92, 1.36, 0.83, 1.04, 0.56, 0.41};

// The brightness of a thin crescent against a sphere's is not known; it is held from this phase on.
constexpr double kMaxPhase_deg = 165;

double disk_phase(SurfaceLaw law, double phase_rad) {
    return law == SurfaceLaw::kLambert ? lambert_phase(phase_rad) : lommel_seeliger_phase(phase_rad);
}
// Geometric albedo of a sphere whose c(0) is 1: 2/3 for Lambert, 1/8 for Lommel-Seeliger.
double full_disk(SurfaceLaw law) { return law == SurfaceLaw::kLambert ? 2.0 / 3 : 1.0 / 8; }

Curve color_of(BodyId id) {
    const double blue = std::pow(10.0, -0.4 * (kColorBv[index_of(id)] - kSunColorBv));
    const double slope = (1 - blue) / 0.11;
    return {{0.28, 0.44, 0.55, 0.65, 2.5},
            {std::max(0.1, 1 - 0.27 * slope), blue, 1, 1 + 0.10 * slope, 1 + 0.10 * slope},
            {}};
}

}  // namespace

double lambert_phase(double g) { return (std::sin(g) + (kPi - g) * std::cos(g)) / kPi; }

double lommel_seeliger_phase(double g) {
    if (g < 1e-6) return 1;
    if (g > kPi - 1e-6) return 0;
    return 1 - std::sin(0.5 * g) * std::tan(0.5 * g) * std::log(1 / std::tan(0.25 * g));
}

double magnitude_v_1au(BodyId id, double phase_rad) {
    const double a = phase_rad / kDegree_rad;
    const auto polynomial = [a](std::initializer_list<double> from_constant) {
        double sum = 0;
        for (auto k = std::rbegin(from_constant); k != std::rend(from_constant); ++k) sum = sum * a + *k;
        return sum;
    };
    switch (id) {
        case BodyId::kMercury:
            return polynomial({-0.613, 6.3280e-2, -1.6336e-3, 3.3644e-5, -3.4265e-7, 1.6893e-9, -3.0334e-12});
        case BodyId::kVenus:
            return a < 163.7 ? polynomial({-4.384, -1.044e-3, 3.687e-4, -2.814e-6, 8.938e-9})
                             : polynomial({236.05828, -2.81914, 8.39034e-3});
        case BodyId::kMoon:
            return polynomial({0.22, 0.026, 0, 0, 4e-9});
        case BodyId::kMars:
            return a <= 50 ? polynomial({-1.601, 2.267e-2, -1.302e-4})
                           : polynomial({-0.367, -2.573e-2, 3.445e-4});
        case BodyId::kJupiter: {
            if (a <= 12) return polynomial({-9.395, -3.7e-4, 6.16e-4});
            const double x = a / 180;
            const double flux = 1 - x * (1.507 + x * (0.363 + x * (0.062 - x * (2.809 - x * 1.876))));
            return -9.428 - 2.5 * std::log10(std::max(flux, 1e-6));
        }
        case BodyId::kSaturn:
            return a <= 6.5 ? polynomial({-8.95, -3.7e-4, 6.16e-4})
                            : polynomial({-8.94, 2.446e-4, 2.672e-4, -1.505e-6, 4.767e-9});
        case BodyId::kUranus:
            return a <= 3.1 ? -7.110 : polynomial({-7.110, 6.587e-3, 1.045e-4});
        case BodyId::kNeptune:
            return a <= 1.9 ? -7.00 : polynomial({-7.00, 7.944e-3, 9.617e-5});
        case BodyId::kEarth:
            break;
    }
    HILCAM_CHECK(!"the Earth has no magnitude law");
    return 0;
}

BodyConfig default_body(BodyId id) {
    BodyConfig config;
    if (id == BodyId::kEarth) {
        config.albedo = Curve::constant(0.3);
        return config;
    }
    config.measured_magnitude = true;
    // Airless, dark surfaces against clouds (and Mars, bright and dusty).
    const bool airless = id == BodyId::kMercury || id == BodyId::kMoon;
    config.law = airless ? SurfaceLaw::kLommelSeeliger : SurfaceLaw::kLambert;
    return config;
}

Fields fields(BodyConfig& c) {
    return {
        optional(flag("visible", c.visible,
                      "true: the body is drawn and reflected, shines on the objects and casts shadow; with "
                      "origin.kind free it is false unless given"),
                 c.has_visible),
        choice("law", c.law, {"lambert", "lommel_seeliger"}, "law by which the surface reflects"),
        flag("measured_magnitude", c.measured_magnitude,
             "true: the body is scaled to its measured V magnitude at every phase, and albedo is then a "
             "factor (not for the Earth)"),
        curve("albedo", c.albedo, {0, 2},
              "albedo (lambert) or w (lommel_seeliger), or a factor on magnitude or map"),
        path("albedo_map", c.albedo_map,
             "equirectangular picture, left edge 180 W, top 90 N; left out: uniform"),
    };
}

BodyLook::BodyLook(BodyId id, const BodyConfig& config, const SpectralGrid& grid)
    : law_(config.law), measured_(config.measured_magnitude), albedo_(grid.average(config.albedo)) {
    require_cover(config.albedo, grid, "albedo");
    if (measured_ && id == BodyId::kEarth)
        throw InputError("earth.measured_magnitude: there is no such law for the Earth; accepted: false");
    if (measured_) albedo_ = albedo_ * grid.average(color_of(id));
    const Figure& figure = kFigures[index_of(id)];
    for (std::size_t i = 0; i < by_degree_.size(); ++i) {
        if (!measured_) {
            by_degree_[i] = 1;
            continue;
        }
        const double g = std::min(static_cast<double>(i), kMaxPhase_deg) * kDegree_rad;
        // Geometric albedo times phase function: flux ratio over (R / 1 au)^2.
        const double ratio = kAstronomicalUnit_m / figure.equatorial_radius_m;
        const double flux = std::pow(10.0, -0.4 * (magnitude_v_1au(id, g) - kSunMagnitudeV)) * ratio * ratio;
        by_degree_[i] = static_cast<float>(flux / (full_disk(law_) * disk_phase(law_, g)));
    }
}

float BodyLook::coefficient(double phase_rad) const {
    const double degrees = std::clamp(phase_rad / kDegree_rad, 0.0, 180.0);
    const auto i = static_cast<std::size_t>(degrees);
    const auto share = static_cast<float>(degrees - static_cast<double>(i));
    return by_degree_[i] + share * (by_degree_[i + 1] - by_degree_[i]);
}

Spectrum BodyLook::reflectance_sr(float mu0, float mu, float cos_phase) const {
    if (!(mu0 > 0)) return {};
    const float law = law_ == SurfaceLaw::kLambert
                          ? mu0 / static_cast<float>(kPi)
                          : mu0 / (4 * static_cast<float>(kPi) * (mu0 + std::max(mu, 0.0f)));
    const float c =
        measured_ ? coefficient(std::acos(std::clamp(static_cast<double>(cos_phase), -1.0, 1.0))) : 1.0f;
    return (c * law) * albedo_;
}

Spectrum BodyLook::disk_albedo(double phase_rad) const {
    return static_cast<float>(static_cast<double>(coefficient(phase_rad)) * full_disk(law_) *
                              disk_phase(law_, phase_rad)) *
           albedo_;
}

}  // namespace hilcam
