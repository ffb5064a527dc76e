#include "render/earth/land_shape.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Roy et al. 2016, table 5, at the middles of Landsat's bands.
struct ShapeWeights {
    double um, even, volume, geometry;
};
constexpr std::array<ShapeWeights, 4> kShapeWeights = {{{0.48, 0.0774, 0.0372, 0.0079},
                                                        {0.56, 0.1306, 0.0580, 0.0178},
                                                        {0.66, 0.1690, 0.0574, 0.0227},
                                                        {0.84, 0.3093, 0.1535, 0.0330}}};
// Means of the kernels under a uniform sky: Lucht, Schaaf & Strahler 2000, table 1.
constexpr double kEvenVolume = 0.189184, kEvenGeometry = -1.377622;
constexpr float kLowestOfShapes = 0.17364818f;  // the cosine of 80 degrees

}  // namespace

LandKernels land_kernels(float mu0, float mu, float cos_azimuth) {
    const float sines = std::sqrt(std::max(0.0f, (1 - mu0 * mu0) * (1 - mu * mu)));
    const float cos_between = std::clamp(mu0 * mu + sines * cos_azimuth, -1.0f, 1.0f),
                between = std::acos(cos_between), sin_between = std::sqrt(1 - cos_between * cos_between);
    constexpr auto kHalfPi = static_cast<float>(0.5 * kPi), kPerPiOfLand = static_cast<float>(1 / kPi);
    const float volume = ((kHalfPi - between) * cos_between + sin_between) / (mu0 + mu) - 0.5f * kHalfPi;
    // Shadows of crowns on the ground, for the Sun and for the viewer, and their overlap.
    const float product = sines / (mu0 * mu);  // product of the tangents
    const float squares = (1 - mu0 * mu0) / (mu0 * mu0) + (1 - mu * mu) / (mu * mu);
    const float across2 = product * product * (1 - cos_azimuth * cos_azimuth);
    const float secants = 1 / mu0 + 1 / mu;
    const float cos_t = std::clamp(
        2 * std::sqrt(std::max(0.0f, squares - 2 * product * cos_azimuth) + across2) / secants, 0.0f, 1.0f);
    const float overlap = kPerPiOfLand * (std::acos(cos_t) - std::sqrt(1 - cos_t * cos_t) * cos_t) * secants;
    return {volume, overlap - secants + 0.5f * (1 + cos_between) / (mu0 * mu)};
}

LandShape::LandShape(const SpectralGrid& grid) {
    Curve even, volume, geometry;
    for (const ShapeWeights& w : kShapeWeights) {
        const double albedo = w.even + kEvenVolume * w.volume + kEvenGeometry * w.geometry;
        for (Curve* curve : {&even, &volume, &geometry}) curve->wavelength_um.push_back(w.um);
        even.value.push_back(w.even / albedo), volume.value.push_back(w.volume / albedo);
        geometry.value.push_back(w.geometry / albedo);
    }
    even_ = grid.average(even), volume_ = grid.average(volume), geometry_ = grid.average(geometry);
}

Spectrum LandShape::of(float mu0, float mu, float cos_phase) const {
    const float sines = std::sqrt(std::max(1e-12f, (1 - mu0 * mu0) * (1 - mu * mu)));
    const LandKernels kernels =
        land_kernels(std::clamp(mu0, kLowestOfShapes, 1.0f), std::clamp(mu, kLowestOfShapes, 1.0f),
                     std::clamp((cos_phase - mu0 * mu) / sines, -1.0f, 1.0f));
    Spectrum out = even_ + kernels.volume * volume_ + kernels.geometry * geometry_;
    for (float& value : out.bin) value = std::max(0.0f, value);
    return out;
}

}  // namespace hilcam
