#include "render/sky/body_photometry.h"

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

// The Moon's single-scattering albedo (body_photometry.h).
Curve moon_scattering() {
    return {
        {0.353, 0.411, 0.467, 0.549, 0.643, 0.687, 0.761, 0.873, 0.937, 1.06, 1.243, 1.586, 1.982, 2.189},
        {0.199, 0.264, 0.286, 0.335, 0.3854, 0.408, 0.4315, 0.463, 0.452, 0.5095, 0.544, 0.625, 0.673, 0.737},
        {}};
}

// The brightness of a thin crescent relative to a sphere's is not known; it is constant from this phase on.
constexpr double kMaxPhase_deg = 165;

double disk_phase(SurfaceLaw law, double phase_rad) {
    return law == SurfaceLaw::kLambert ? lambert_phase(phase_rad) : lommel_seeliger_phase(phase_rad);
}
std::string name_of(BodyId id) {
    return index_of(id) < kBodyCount ? std::string(kBodyNames[index_of(id)]) : "look";
}

Curve moon_color();

Curve color_of(BodyId id) {
    if (id == BodyId::kMoon) return moon_color();
    const double blue = std::pow(10.0, -0.4 * (kColorBv[index_of(id)] - kSunColorBv));
    const double slope = (1 - blue) / 0.11;
    return {{0.28, 0.44, 0.55, 0.65, 2.5},
            {std::max(0.1, 1 - 0.27 * slope), blue, 1, 1 + 0.10 * slope, 1 + 0.10 * slope},
            {}};
}

// ROLO's disk reflectance at 30 deg of phase, mean of waxing and waning, relative to its bands at 544 to 554
// nm: Kieffer & Stone, Astron. J. 129, 2887, 2005, eq. 10 and table 4 at the mean libration, neighbouring
// bands combined.
Curve moon_color() {
    return {{0.353, 0.411, 0.442, 0.476, 0.549, 0.687, 0.761, 0.873, 0.937, 1.06, 1.243, 1.586, 1.982, 2.254},
            {0.558, 0.762, 0.791, 0.851, 1, 1.262, 1.351, 1.474, 1.429, 1.669, 1.823, 2.219, 2.489, 2.986},
            {}};
}

}  // namespace

double sphere_brightness(SurfaceLaw law, double phase_rad) {
    return (law == SurfaceLaw::kLambert ? 2.0 / 3 : 1.0 / 8) * disk_phase(law, phase_rad);
}

double disk_m2_of_magnitude(double magnitude) {
    return std::pow(10.0, -0.4 * (magnitude - kSunMagnitudeV)) * kAstronomicalUnit_m * kAstronomicalUnit_m;
}

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
    config.heat = default_heat(id);
    if (id == BodyId::kEarth) {
        config.albedo = Curve::constant(0.3);
        return config;
    }
    config.measured_magnitude = true;
    // Airless, dark surfaces versus clouds (and Mars, bright and dusty).
    const bool airless = id == BodyId::kMercury || id == BodyId::kMoon;
    config.law = airless ? SurfaceLaw::kLommelSeeliger : SurfaceLaw::kLambert;
    config.rings = id == BodyId::kSaturn;
    return config;
}

Fields fields(BodyConfig& c) {
    return {
        optional(flag("visible", c.visible,
                      "true: the body is drawn and reflected, lights objects and casts shadows; with "
                      "origin.kind: free, false unless given"),
                 c.has_visible),
        choice("law", c.law, {"lambert", "lommel_seeliger", "hapke"},
               "reflection law of the surface; hapke is that of regolith, not scaled to a magnitude"),
        optional(flag("measured_magnitude", c.measured_magnitude,
                      "true: the body is scaled to its measured V magnitude at every phase angle, and albedo "
                      "is a factor on that (not for the Earth, nor with law hapke)"),
                 c.has_measured),
        optional(
            curve(
                "albedo", c.albedo, {0, 2},
                "albedo (lambert), w (lommel_seeliger) or single-scattering albedo (hapke; the Moon has its "
                "own), or a factor on magnitude or map"),
            c.has_albedo),
        section("regolith", c.regolith, "parameters of the law hapke; left out: those of the Moon"),
        path("albedo_map", c.albedo_map,
             "equirectangular picture with left edge 180 W and top edge 90 N; left out: uniform"),
        choice("albedo_map_latitudes", c.albedo_map_latitudes, {"planetographic", "planetocentric"},
               "kind of the picture's latitudes, which differ on a flattened body; most maps of Mars, Ceres "
               "and Vesta are planetocentric"),
        number("albedo_map_reference", c.albedo_map_reference, 1, {0, 1},
               "value of the map, linear, at which the law's albedo or the magnitude applies; 0: the map's "
               "mean"),
        path("height_map", c.height_map,
             "heights above the sphere of a round body, one number a pixel (TIFF or PNG), placed as "
             "albedo_map; left out: smooth"),
        number("height_step_m", c.height_step_m, 1, {1e-3, 1e6}, "height per unit of height_map"),
        number("height_zero_m", c.height_zero_m, 1, {-1e6, 1e6}, "height at the value 0 of height_map"),
        flag("planetshine", c.planetshine, "true: light from the other bodies is added (earthshine)"),
        section("heat", c.heat, "temperature and emission beyond 2.5 um (docs/thermal.md)"),
        flag("rings", c.rings,
             "true: the rings are drawn, shade the body and are shaded by it; default: true for saturn. As a "
             "point the body has their light either way"),
    };
}

void validate(const BodyConfig& c) {
    if (c.law == SurfaceLaw::kHapke && c.has_measured && c.measured_magnitude)
        throw KeyError("measured_magnitude",
                       "found true with law: hapke, which has its own scale; accepted: false");
    if (c.albedo_map_reference > 0 && c.albedo_map.empty())
        throw KeyError("albedo_map_reference", "has no effect without albedo_map; accepted: both or neither");
    if (c.albedo_map_latitudes != MapLatitude::kPlanetographic && c.albedo_map.empty())
        throw KeyError("albedo_map_latitudes", "has no effect without albedo_map; accepted: both or neither");
    if ((c.height_step_m != 1 || c.height_zero_m != 0) && c.height_map.empty())
        throw KeyError(c.height_step_m != 1 ? "height_step_m" : "height_zero_m",
                       "has no effect without height_map; accepted: both or neither");
}

Fields fields(RegolithConfig& r) {
    return {
        number("lobe_width", r.lobe_width, 1, {0, 0.95},
               "b of hapke: width of both lobes of the phase function"),
        number("lobe_backward", r.lobe_backward, 1, {-1, 1},
               "c of hapke: (1 + c) / 2 is the share of the lobe that scatters backward"),
        number("surge_amplitude", r.surge_amplitude, 1, {0, 10}, "amplitude of the opposition surge"),
        number("surge_width", r.surge_width, 1, {1e-4, 1}, "angular width of the opposition surge"),
        number("slope_deg", r.slope_rad, kDegree_rad, {0, 60}, "mean slope of the surface roughness"),
    };
}

BodyLook::BodyLook(BodyId id, const BodyConfig& config, const SpectralGrid& grid)
    : law_(config.law),
      measured_(config.measured_magnitude && config.law != SurfaceLaw::kHapke),
      albedo_(grid.average(config.albedo)),
      heat_(config.heat, grid),
      bins_(grid.size()) {
    require_solar_cover(config.albedo, grid, "albedo");
    if (law_ == SurfaceLaw::kHapke) {
        if (!config.has_albedo && id != BodyId::kMoon)
            throw InputError(
                name_of(id) +
                ".albedo: not given with law: hapke; accepted: the single-scattering albedo, 0 to 1");
        if (!config.has_albedo) albedo_ = grid.average(moon_scattering());
        for (int b = 0; b < bins_; ++b)
            if (albedo_[b] > 1)
                throw InputError(
                    name_of(id) +
                    ".albedo: found above 1 with law: hapke; accepted: a single-scattering albedo, 0 to 1");
        const RegolithConfig& r = config.regolith;
        hapke_ = {static_cast<float>(r.lobe_width), static_cast<float>(r.lobe_backward),
                  static_cast<float>(r.surge_amplitude), static_cast<float>(r.surge_width),
                  static_cast<float>(std::tan(r.slope_rad))};
        integrate_disk();
        return;
    }
    if (measured_ && id == BodyId::kEarth)
        throw InputError("earth.measured_magnitude: there is no such law for the Earth; accepted: false");
    if (measured_ && index_of(id) < kBodyCount) albedo_ = albedo_ * grid.average(color_of(id));
    if (measured_ && index_of(id) >= kBodyCount)
        throw InputError("look.measured_magnitude: there is no such law for it; accepted: false");
    for (std::size_t i = 0; i < by_degree_.size(); ++i) {
        if (!measured_) {
            by_degree_[i] = 1;
            continue;
        }
        const double g = std::min(static_cast<double>(i), kMaxPhase_deg) * kDegree_rad;
        // Geometric albedo times phase function: the disk over the ellipse seen from the equator.
        const Figure& figure = kFigures[index_of(id)];
        const double disk = disk_m2_of_magnitude(magnitude_v_1au(id, g)) /
                            (figure.equatorial_radius_m * figure.polar_radius_m);
        by_degree_[i] = static_cast<float>(disk / sphere_brightness(law_, g));
    }
}

float BodyLook::coefficient(double phase_rad) const {
    const double degrees = std::clamp(phase_rad / kDegree_rad, 0.0, 180.0);
    const auto i = static_cast<std::size_t>(degrees);
    const auto share = static_cast<float>(degrees - static_cast<double>(i));
    return by_degree_[i] + share * (by_degree_[i + 1] - by_degree_[i]);
}

// Integrates the visible lit part of a unit sphere, seen along z: over chords along y, which the phase does
// not shorten, and along each of them.
void BodyLook::integrate_disk() {
    constexpr int kRows = 24, kColumns = 64;
    for (int degree = 0; degree <= 181; ++degree) {
        const double g = std::min(degree, 180) * kDegree_rad;
        Spectrum sum;
        for (int j = 0; j < kRows; ++j) {
            const double y = std::sin(0.5 * kPi * (j + 0.5) / kRows);
            const double half = std::sqrt(1 - y * y), strip = 0.5 * kPi / kRows * half;
            // From the terminator to the bright limb, by longitude along the chord.
            const double least = g - 0.5 * kPi, most = 0.5 * kPi;
            for (int i = 0; i < kColumns; ++i) {
                const double lon = least + (most - least) * (i + 0.5) / kColumns;
                const auto mu = static_cast<float>(half * std::cos(lon)),
                           mu0 = static_cast<float>(half * std::cos(lon - g));
                const double area = strip * (most - least) / kColumns * half * std::cos(lon);
                sum +=
                    static_cast<float>(2 * area) * reflectance_sr(mu0, mu, static_cast<float>(std::cos(g)));
            }
        }
        disk_by_degree_.push_back(sum);
    }
}

Spectrum BodyLook::max_sr() const {
    if (law_ != SurfaceLaw::kHapke) return reflectance_sr(1, 0, 1);
    Spectrum most;
    for (const auto& [mu0, mu, cosine] :
         {std::array{1.0f, 1.0f, 1.0f}, {1.0f, 0.02f, 0.02f}, {0.1f, 0.02f, 0.99f}}) {
        const Spectrum at = reflectance_sr(mu0, mu, cosine);
        for (int b = 0; b < bins_; ++b) most[b] = std::max(most[b], at[b]);
    }
    return most;
}

Spectrum BodyLook::reflectance_sr(float mu0, float mu, float cos_phase) const {
    if (!(mu0 > 0)) return {};
    if (heat_.none()) return solar_reflectance_sr(mu0, mu, cos_phase);
    Spectrum out = solar_reflectance_sr(mu0, mu, cos_phase);
    for (int b = 0; b < bins_; ++b)
        if (heat_.is_thermal(b)) out[b] = mu0 / static_cast<float>(kPi) * heat_.reflected()[b];
    return out;
}

Spectrum BodyLook::solar_reflectance_sr(float mu0, float mu, float cos_phase) const {
    if (law_ == SurfaceLaw::kHapke) {
        const HapkeGeometry g = hapke_geometry(hapke_, std::max(mu, 1e-3f), mu0, cos_phase);
        Spectrum out;
        for (int b = 0; b < bins_; ++b) out[b] = mu0 * hapke(g, albedo_[b]);
        return out;
    }
    const float law = law_ == SurfaceLaw::kLambert
                          ? mu0 / static_cast<float>(kPi)
                          : mu0 / (4 * static_cast<float>(kPi) * (mu0 + std::max(mu, 0.0f)));
    const float c =
        measured_ ? coefficient(std::acos(std::clamp(static_cast<double>(cos_phase), -1.0, 1.0))) : 1.0f;
    return (c * law) * albedo_;
}

Spectrum BodyLook::disk_albedo(double phase_rad) const {
    if (law_ == SurfaceLaw::kHapke) {
        const double degrees = std::clamp(phase_rad / kDegree_rad, 0.0, 180.0);
        const auto i = static_cast<std::size_t>(degrees);
        const auto share = static_cast<float>(degrees - static_cast<double>(i));
        return (1 - share) * disk_by_degree_[i] + share * disk_by_degree_[i + 1];
    }
    Spectrum out = static_cast<float>(disk_brightness(phase_rad)) * albedo_;
    if (heat_.none()) return out;
    const auto lambert = static_cast<float>(2.0 / 3 * lambert_phase(phase_rad));
    for (int b = 0; b < bins_; ++b)
        if (heat_.is_thermal(b)) out[b] = lambert * heat_.reflected()[b];
    return out;
}

double BodyLook::disk_brightness(double phase_rad) const {
    return static_cast<double>(coefficient(phase_rad)) * sphere_brightness(law_, phase_rad);
}

}  // namespace hilcam
