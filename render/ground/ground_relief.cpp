#include "render/ground/ground_relief.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/ground/cube_sphere.h"
#include "render/ground/relief_noise.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr int kMaxOctaves = 32;

double noise(Vec3d place) {
    double value = 0;
    add_wave({7, 0, 1, {}, 1}, {&place, 1}, {&value, 1});
    return value;
}

// Returns the mean squared difference of the noise over a distance in wavelengths, measured at fixed places.
double mean_square_difference(double distance) {
    constexpr int kPlaces = 2048;
    double sum = 0;
    for (int i = 0; i < kPlaces; ++i) {
        // A low-discrepancy sequence in three dimensions (Roberts 2018).
        const Vec3d p{37.3 * std::fmod(0.8191725134 * i, 1.0) + 0.1,
                      37.3 * std::fmod(0.6710436067 * i, 1.0) + 0.1,
                      37.3 * std::fmod(0.5497004779 * i, 1.0) + 0.1};
        const double turn = 2.39996 * i, z = std::fmod(0.754877666 * i, 1.0) * 2 - 1,
                     r = std::sqrt(1 - z * z);
        const double d = noise(p + distance * Vec3d{r * std::cos(turn), r * std::sin(turn), z}) - noise(p);
        sum += d * d;
    }
    return sum / kPlaces;
}

}  // namespace

Fields fields(ReliefSettings& r) {
    return {
        integer("seed", r.seed, {0, 9e15}, "seed of the relief, independent of the scenario's seed"),
        number("deviation_m", r.deviation_m, 1, {0, 1e5},
               "rms height difference between points at_m apart; 0: this and hurst are measured on the "
               "finest height map"),
        number("at_m", r.at_m, 1, {1e-3, 1e6}, "distance between points at which deviation_m applies"),
        number("hurst", r.hurst, 1, {0.1, 0.99},
               "Hurst exponent: height differences grow as this power of the distance"),
        number("longest_m", r.longest_m, 1, {0, 1e6},
               "longest wavelength; 0: twice the post spacing of the finest height map"),
    };
}

std::optional<ReliefSettings> measured_relief(GroundSurface& surface, double spacing_m) {
    constexpr int kPlaces = 1500;
    const double radius_m = surface.figure().equatorial_radius_m;
    constexpr std::array<double, 3> kLags = {1, 2, 4};
    std::vector<Vec3d> places;
    for (int i = 0; i < kPlaces; ++i) {
        // Uniform over the sphere: a golden-angle spiral.
        const double z = 1 - 2 * (i + 0.5) / kPlaces, r = std::sqrt(1 - z * z), turn = 2.399963229728653 * i;
        const Vec3d at{r * std::cos(turn), r * std::sin(turn), z};
        const auto [east, north] = axes_along(at);
        const Vec3d way = std::cos(turn * 7) * east + std::sin(turn * 7) * north;
        places.push_back(at);
        for (const double lag : kLags) places.push_back(normalized(at + lag * spacing_m / radius_m * way));
    }
    std::vector<double> heights_m(places.size());
    surface.find_heights(places, 0, heights_m);
    std::array<double, 3> log_rms{};
    for (std::size_t k = 0; k < kLags.size(); ++k) {
        double sum = 0;
        for (std::size_t i = 0; i < kPlaces; ++i) {
            const double d = heights_m[4 * i + k + 1] - heights_m[4 * i];
            sum += d * d;
        }
        if (!(sum > 0)) return {};
        log_rms[k] = 0.5 * std::log2(sum / kPlaces);
    }
    ReliefSettings out;
    // A line through three points at lags of 1, 2 and 4: its slope is that between the outer ones.
    out.hurst = std::clamp(0.5 * (log_rms[2] - log_rms[0]), 0.3, 0.98);
    out.at_m = 2 * spacing_m;
    out.deviation_m = std::exp2((log_rms[0] + log_rms[1] + log_rms[2]) / 3);
    out.longest_m = 2 * spacing_m;
    return out;
}

GroundRelief::GroundRelief(double radius_m, const ReliefSettings& settings)
    : radius_m_(radius_m), settings_(settings) {
    // Octaves in proportion to wavelength^hurst, scaled to the wanted deviation. That includes longer
    // octaves, which are in the map.
    constexpr int kLonger = 12;
    const double probe_m = 0.1 * settings.longest_m;
    double sum = 0;
    for (int k = -kLonger; k < kMaxOctaves; ++k) {
        const double share = std::exp2(-k), amplitude = std::pow(share, settings.hurst);
        sum += amplitude * amplitude * mean_square_difference(probe_m / (settings.longest_m * share));
        if (k < 0) continue;
        wavelength_m_.push_back(settings.longest_m * share);
        amplitude_m_.push_back(amplitude);
    }
    const double wanted_m = settings.deviation_m * std::pow(probe_m / settings.at_m, settings.hurst);
    for (double& amplitude_m : amplitude_m_) amplitude_m *= wanted_m / std::sqrt(sum);
}

void GroundRelief::add_octaves(const GroundPatch& patch, double min_m, double below_m) const {
    for (std::size_t k = 0; k < wavelength_m_.size(); ++k) {
        if (wavelength_m_[k] < min_m || wavelength_m_[k] >= below_m) continue;
        // The lattices of octaves differ only by their offsets.
        const double shift = 0.37 * static_cast<double>(k);
        add_wave({static_cast<std::uint64_t>(settings_.seed), static_cast<int>(k),
                  radius_m_ / wavelength_m_[k], Vec3d{shift, 0.5 * shift, -shift}, amplitude_m_[k]},
                 patch.places, patch.heights_m);
    }
}

// A wave of fewer texels is left out.
void GroundRelief::add(const GroundPatch& patch) const {
    constexpr double kMinTexels = 3;
    add_octaves(patch, kMinTexels * patch.texel_m, kWideTexels * patch.texel_m);
}

void GroundRelief::add_wide(const GroundPatch& patch) const {
    add_octaves(patch, kWideTexels * patch.texel_m, std::numeric_limits<double>::infinity());
}

}  // namespace hilcam
