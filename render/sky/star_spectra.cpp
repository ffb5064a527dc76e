#include "render/sky/star_spectra.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/vocabulary/table.h"

namespace hilcam {
namespace {

constexpr std::size_t kWavelengths = 99;
struct LibraryStar {
    const char* type;
    double v_i, b_v;
    std::array<double, kWavelengths> flux;  // over its mean in V
};

#include "render/sky/star_spectra_table.inc"

static_assert(kWavelengths_um.size() == kWavelengths);

// Irradiance at 0.545 um of a star of V = 0 (Bessell, Castelli & Plez, Astron. Astrophys. 333, 231, 1998,
// table A2).
constexpr double kZeroMagnitude_w_m2_um = 3.631e-8;

// 0 at V, 1 at B and below. A tilt of a magnitude reddens B-V by kTiltInBv and dims V by kTiltInV: for
// Bessell's passbands, within 0.02 for the library's spectra.
constexpr double kTiltInBv = 0.735, kTiltInV = 0.054;

// Returns the mean over a bin beyond the library's end, over the value at the end: Rayleigh and Jeans' law,
// the fourth power of the wavelength. Cool stars are up to a fifth fainter there, dusty ones brighter.
float infrared_tail(double from_um, double to_um) {
    const double end_um = kWavelengths_um.back();
    const auto third = [&](double um) { return std::pow(end_um / um, 3); };
    return static_cast<float>(end_um / 3 * (third(from_um) - third(to_um)) / (to_um - from_um));
}

double blue_tilt(double wavelength_um) { return std::clamp((0.53 - wavelength_um) / 0.09, 0.0, 1.0); }

}  // namespace

double v_i_of_b_v(double b_v) {
    static const Table table{{-0.33, -0.30, -0.26, -0.20, -0.16, -0.11, -0.07, -0.02, 0.05, 0.08, 0.15,
                              0.20,  0.30,  0.35,  0.44,  0.52,  0.58,  0.63,  0.68,  0.74, 0.81, 0.94,
                              1.00,  1.07,  1.16,  1.38,  1.50,  1.56,  1.58,  1.60,  1.65, 1.80, 2.50},
                             {-0.37, -0.31, -0.24, -0.16, -0.08, -0.06, -0.04, 0.00, 0.05, 0.10, 0.16,
                              0.24,  0.37,  0.45,  0.51,  0.61,  0.66,  0.71,  0.74, 0.80, 0.87, 0.92,
                              0.97,  1.04,  1.12,  1.33,  1.53,  1.64,  1.75,  1.86, 2.05, 2.30, 3.10}};
    return table.at(b_v);
}

StarSpectra::StarSpectra(const SpectralGrid& grid) : grid_(grid) {
    for (const LibraryStar& star : kLibrary) {
        Spectrum logs = grid.average(
            {{kWavelengths_um.begin(), kWavelengths_um.end()}, {star.flux.begin(), star.flux.end()}, {}});
        for (int b = grid.solar_bins(); b < grid.size(); ++b)
            logs[b] = static_cast<float>(star.flux.back()) * infrared_tail(grid.from_um(b), grid.to_um(b));
        for (int b = 0; b < grid.size(); ++b) logs[b] = std::log(logs[b]);
        logs_.push_back(logs);
    }
    // Three-point Gauss-Legendre over a bin.
    for (int b = 0; b < grid.size(); ++b) {
        const double middle = grid.center_um(b), reach = 0.5 * grid.width_um(b) * std::sqrt(0.6);
        blue_.push_back(static_cast<float>(
            (5 * blue_tilt(middle - reach) + 8 * blue_tilt(middle) + 5 * blue_tilt(middle + reach)) / 18));
    }
}

namespace {

// A position between two stars of the library.
struct Between {
    std::size_t star;  // the bluer one
    double share;      // weight of the redder one

    explicit Between(double v_i) {
        const auto* const after =
            std::upper_bound(kLibrary.begin(), kLibrary.end(), v_i,
                             [](double value, const LibraryStar& s) { return value < s.v_i; });
        star = static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(after - kLibrary.begin(), 1, std::ssize(kLibrary) - 1) - 1);
        // Slightly beyond the first and the last.
        share =
            std::clamp((v_i - kLibrary[star].v_i) / (kLibrary[star + 1].v_i - kLibrary[star].v_i), -0.5, 1.5);
    }
    double b_v() const { return (1 - share) * kLibrary[star].b_v + share * kLibrary[star + 1].b_v; }
};

}  // namespace

Spectrum StarSpectra::irradiance_w_m2_um(double magnitude_v, const Colors& colors) const {
    const double v_i = colors.v_i.value_or(v_i_of_b_v(colors.b_v));
    // The tilt makes V fainter; the scale and the position in the library compensate for that.
    const double tilt_mag = std::clamp((colors.b_v - Between(v_i).b_v()) / kTiltInBv, -1.5, 1.5);
    const Between place(v_i - kTiltInV * tilt_mag);
    const double scale = kZeroMagnitude_w_m2_um * std::pow(10.0, -0.4 * (magnitude_v - kTiltInV * tilt_mag));
    const double per_mag = -0.4 * std::log(10.0);
    Spectrum out;
    for (int b = 0; b < grid_.size(); ++b) {
        const auto log_of = [&](std::size_t star) { return static_cast<double>(logs_[star][b]); };
        const double log = (1 - place.share) * log_of(place.star) + place.share * log_of(place.star + 1) +
                           per_mag * tilt_mag * static_cast<double>(blue_[static_cast<std::size_t>(b)]);
        out[b] = static_cast<float>(scale * std::exp(log));
    }
    return out;
}

}  // namespace hilcam
