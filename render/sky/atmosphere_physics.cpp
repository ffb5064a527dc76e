#include "render/sky/atmosphere_physics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/sky/standard_air.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Serdyuchenko et al. 2014 at 233 K, 0.36 to 0.83 um in steps of 0.01 [m^2].
constexpr auto kOzone_m2 = std::to_array<double>(
    {1.18e-27,  2.182e-28, 2.818e-28, 6.636e-28, 1.527e-27, 2.763e-27, 5.52e-27,  8.451e-27,
     1.582e-26, 2.316e-26, 3.669e-26, 4.924e-26, 7.752e-26, 9.016e-26, 1.48e-25,  1.602e-25,
     2.139e-25, 2.755e-25, 3.091e-25, 3.5e-25,   4.266e-25, 4.672e-25, 4.398e-25, 4.701e-25,
     5.019e-25, 4.305e-25, 3.74e-25,  3.215e-25, 2.662e-25, 2.238e-25, 1.852e-25, 1.473e-25,
     1.209e-25, 9.423e-26, 7.455e-26, 6.566e-26, 5.105e-26, 4.15e-26,  4.228e-26, 3.237e-26,
     2.451e-26, 2.801e-26, 2.534e-26, 1.624e-26, 1.465e-26, 2.078e-26, 1.383e-26, 7.105e-27});
// One Dobson unit: 0.01 mm of gas at 0 deg C and 101325 Pa (Loschmidt's constant, CODATA 2018).
constexpr double kDobson_m2 = 2.686780111e20;
// Steps of the table by height. With linear interpolation the density is off by (step / scale height)^2 / 8,
// 4e-5 at most.
constexpr double kHeightStep_m = 100;
constexpr int kHeightSteps = static_cast<int>(AirPhysics::kTop_m / kHeightStep_m);

double ozone_m2(double wavelength_um) {
    const double x = (wavelength_um - 0.36) / 0.01;
    if (x <= 0) return kOzone_m2.front();
    const auto i = static_cast<std::size_t>(x);
    if (i + 1 >= kOzone_m2.size()) return 0;
    return kOzone_m2[i] + (x - static_cast<double>(i)) * (kOzone_m2[i + 1] - kOzone_m2[i]);
}

// Returns the mean over a bin, by 16 midpoints.
template <class Function>
Spectrum bin_mean(const SpectralGrid& grid, const Function& function) {
    Spectrum out;
    constexpr int kSteps = 16;
    for (int b = 0; b < grid.size(); ++b) {
        double sum = 0;
        for (int i = 0; i < kSteps; ++i)
            sum += function(grid.from_um(b) + (i + 0.5) / kSteps * grid.width_um(b));
        out[b] = static_cast<float>(sum / kSteps);
    }
    return out;
}

}  // namespace

double rayleigh_optical_depth(double wavelength_um) {
    const double l2 = wavelength_um * wavelength_um;
    return 0.0021520 * (1.0455996 - 341.29061 / l2 - 0.90230850 * l2) /
           (1 + 0.0027059889 / l2 - 85.968563 * l2);
}

Fields fields(AtmosphereConfig& c) {
    return {
        text("model", c.model, "atmosphere model: none, precomputed, table, or a plug-in's"),
        number("pressure_hpa", c.pressure_pa, 100, {0, 1100}, "precomputed: air pressure at the ground"),
        number("aerosol_optical_depth", c.aerosol_optical_depth, 1, {0, 5},
               "precomputed: vertical optical depth of the aerosol at 0.55 um"),
        number("angstrom_exponent", c.angstrom_exponent, 1, {-1, 4},
               "precomputed: Angstrom exponent of the aerosol's optical depth"),
        number("aerosol_scale_height_km", c.aerosol_scale_height_m, 1000, {0.1, 20},
               "precomputed: scale height of the aerosol"),
        number("aerosol_asymmetry", c.aerosol_asymmetry, 1, {-0.95, 0.95},
               "precomputed: asymmetry g of the aerosol's phase function"),
        number("aerosol_single_albedo", c.aerosol_single_albedo, 1, {0, 1},
               "precomputed: single-scattering albedo of the aerosol"),
        number("ozone_du", c.ozone_du, 1, {0, 1000}, "precomputed: ozone column in Dobson units"),
        optional(number("ground_albedo", c.ground_albedo, 1, {0, 1},
                        "precomputed: albedo of the ground and clouds for light between ground and sky; left "
                        "out: the albedo of the Earth's ground and clouds by place"),
                 c.has_ground_albedo),
        path("cache", c.cache, "precomputed: folder of the tables; left out: hilcam's own folder"),
        path("table", c.table, "table: CSV of values or of MODTRAN runs, as described in docs/atmosphere.md"),
    };
}

void validate(const AtmosphereConfig& c) {
    if ((c.model == "table") == c.table.empty())
        throw InputError(c.table.empty() ? "table: found none; accepted: a file, as the model is table"
                                         : "table: found a file; accepted: none, as the model is not table");
}

AirPhysics::AirPhysics(const AtmosphereConfig& c, const SpectralGrid& grid)
    : aerosol_height_m_(c.aerosol_scale_height_m), asymmetry_(static_cast<float>(c.aerosol_asymmetry)) {
    // Columns of the interpolated table, so that optical depths do not depend on the steps.
    double air_m = 0, ozone_m = 0;
    for (int i = 0; i <= kHeightSteps; ++i) {
        const double share_m = i == 0 || i == kHeightSteps ? 0.5 * kHeightStep_m : kHeightStep_m;
        air_m += share_m * standard_air_density(i * kHeightStep_m);
        ozone_m += share_m * standard_ozone_m3(i * kHeightStep_m);
    }
    shares_.reserve(kHeightSteps + 1);
    for (int i = 0; i <= kHeightSteps; ++i)
        shares_.push_back({static_cast<float>(standard_air_density(i * kHeightStep_m) / air_m),
                           static_cast<float>(standard_ozone_m3(i * kHeightStep_m) / ozone_m)});
    rayleigh_ =
        bin_mean(grid, [&](double um) { return rayleigh_optical_depth(um) * c.pressure_pa / 101325; });
    ozone_ = bin_mean(grid, [&](double um) { return ozone_m2(um) * c.ozone_du * kDobson_m2; });
    // The exponential is cut off at the top; the column is corrected for that.
    const double aerosol_m = aerosol_height_m_ * (1 - std::exp(-kTop_m / aerosol_height_m_));
    aerosol_extinction_ = bin_mean(grid, [&](double um) {
        return c.aerosol_optical_depth * std::pow(um / 0.55, -c.angstrom_exponent) / aerosol_m;
    });
    aerosol_scattering_ = static_cast<float>(c.aerosol_single_albedo) * aerosol_extinction_;
}

AirAt AirPhysics::at(double height_m) const {
    const double h = std::clamp(height_m, 0.0, kTop_m), step = h / kHeightStep_m;
    const auto i = std::min(static_cast<std::size_t>(step), shares_.size() - 2);
    const auto f = static_cast<float>(step - static_cast<double>(i));
    const Shares &low = shares_[i], &high = shares_[i + 1];
    AirAt out;
    out.rayleigh = (low.air_m + f * (high.air_m - low.air_m)) * rayleigh_;
    const auto haze = static_cast<float>(std::exp(-h / aerosol_height_m_));
    out.aerosol = haze * aerosol_scattering_;
    out.extinction = haze * aerosol_extinction_;
    out.extinction += out.rayleigh;
    out.extinction += (low.ozone_m + f * (high.ozone_m - low.ozone_m)) * ozone_;
    return out;
}

float AirPhysics::rayleigh_phase(float c) const { return 3 / (16 * static_cast<float>(kPi)) * (1 + c * c); }

float AirPhysics::aerosol_phase(float c) const {
    const float g = asymmetry_, g2 = g * g;
    const float x = std::max(1e-6f, 1 + g2 - 2 * g * c);
    return 3 / (8 * static_cast<float>(kPi)) * (1 - g2) * (1 + c * c) / ((2 + g2) * x * std::sqrt(x));
}

}  // namespace hilcam
