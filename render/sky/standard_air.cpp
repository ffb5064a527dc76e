#include "render/sky/standard_air.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace hilcam {
namespace {

// The standard's constants: radius for geopotential height, gravity, mean molar mass, gas constant; and sea
// level.
constexpr double kStandardRadius_m = 6356766, kGravity_m_s2 = 9.80665, kMolarMass_kg = 0.0289644,
                 kGasConstant_j_k = 8.31432, kSeaLevel_k = 288.15;
constexpr double kKelvinPerMetre = kGravity_m_s2 * kMolarMass_kg / kGasConstant_j_k;

// Table 4: the bottom of each layer by geopotential height, and its gradient of molecular-scale temperature.
struct StandardLayer {
    double bottom_m, k_per_m;
};
constexpr std::array<StandardLayer, 7> kStandardLayers = {
    {{0, -6.5e-3}, {11e3, 0}, {20e3, 1e-3}, {32e3, 2.8e-3}, {47e3, 0}, {51e3, -2.8e-3}, {71e3, -2e-3}}};
constexpr double kTopOfLayers_m = 86e3;  // geometric

// Table I: density over that at sea level.
struct StandardLevel {
    double height_m, density;
};
constexpr std::array<StandardLevel, 4> kStandardLevels = {
    {{86e3, 5.680e-6}, {90e3, 2.789e-6}, {95e3, 1.137e-6}, {100e3, 4.575e-7}}};

double layered_density(double height_m) {
    const double geopotential_m = kStandardRadius_m * height_m / (kStandardRadius_m + height_m);
    double kelvin = kSeaLevel_k, pressure = 1;
    for (std::size_t i = 0; i < kStandardLayers.size(); ++i) {
        const double top_m =
            i + 1 < kStandardLayers.size() ? kStandardLayers[i + 1].bottom_m : geopotential_m;
        const double thick_m = std::min(geopotential_m, top_m) - kStandardLayers[i].bottom_m;
        const double gradient = kStandardLayers[i].k_per_m, above = kelvin + gradient * thick_m;
        pressure *= gradient == 0 ? std::exp(-kKelvinPerMetre * thick_m / kelvin)
                                  : std::pow(kelvin / above, kKelvinPerMetre / gradient);
        kelvin = above;
        if (geopotential_m <= top_m) break;
    }
    return pressure * kSeaLevel_k / kelvin;
}

// At 2, 4 ... 74 km [m^-3].
constexpr double kOzoneStep_m = 2000;
constexpr auto kOzone_m3 = std::to_array<double>(
    {6.8e17,  5.8e17,  5.7e17,  6.5e17,  1.13e18, 2.02e18, 2.35e18, 2.95e18, 4.04e18, 4.77e18,
     4.86e18, 4.54e18, 4.03e18, 3.24e18, 2.52e18, 2.03e18, 1.58e18, 1.22e18, 8.73e17, 6.07e17,
     3.98e17, 2.74e17, 1.69e17, 1.03e17, 6.64e16, 3.84e16, 2.55e16, 1.61e16, 1.12e16, 7.33e15,
     4.81e15, 3.17e15, 1.72e15, 7.5e14,  5.4e14,  2.2e14,  1.7e14});

}  // namespace

double standard_air_density(double height_m) {
    const double h = std::clamp(height_m, 0.0, kStandardLevels.back().height_m);
    if (h <= kTopOfLayers_m) return layered_density(h);
    std::size_t i = 0;
    while (h > kStandardLevels[i + 1].height_m) ++i;
    const StandardLevel &low = kStandardLevels[i], &high = kStandardLevels[i + 1];
    return low.density *
           std::pow(high.density / low.density, (h - low.height_m) / (high.height_m - low.height_m));
}

double standard_ozone_m3(double height_m) {
    const double at = std::max(0.0, height_m / kOzoneStep_m - 1);
    const auto i = static_cast<std::size_t>(at);
    if (i + 1 >= kOzone_m3.size()) return 0;
    return kOzone_m3[i] + (at - static_cast<double>(i)) * (kOzone_m3[i + 1] - kOzone_m3[i]);
}

}  // namespace hilcam
