#include "render/earth/land_colors.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

// Linear colours of the picture, and reflectances in red, green and blue, over the Amazon and the Congo
// (PROSAIL's canopy), the site Libya-4, Dome C and Greenland (Grenfell, Warren & Mullen 1994).
constexpr std::array<float, 3> kForestPicture{0.0096f, 0.0207f, 0.0032f}, kForest{0.029f, 0.045f, 0.020f};
constexpr std::array<float, 3> kSandPicture{0.616f, 0.449f, 0.248f}, kSand{0.46f, 0.35f, 0.25f};
constexpr std::array<float, 3> kSnowPicture{0.89f, 0.92f, 0.93f}, kSnow{0.975f, 0.98f, 0.975f};
constexpr float kForestInfrared = 0.40f, kSandInfrared = 0.58f, kSnowInfrared = 0.93f;

float between(float x, float x0, float x1, float y0, float y1) {
    return y0 + (x - x0) / (x1 - x0) * (y1 - y0);
}

// Linear between five points in logarithms, constant beyond the outer ones.
float power_law(float value, std::size_t c) {
    const std::array<float, 5> x{kForestPicture[c] / 8, kForestPicture[c], kSandPicture[c], kSnowPicture[c],
                                 1};
    const std::array<float, 5> y{kForest[c] / 4, kForest[c], kSand[c], kSnow[c], 0.985f};
    constexpr float kMin = 1e-4f;
    const float at = std::log(std::clamp(value, std::max(kMin, x.front()), x.back()));
    std::size_t i = 0;
    while (i + 2 < x.size() && at > std::log(x[i + 1])) ++i;
    return std::exp(between(at, std::log(x[i]), std::log(x[i + 1]), std::log(y[i]), std::log(y[i + 1])));
}

}  // namespace

BandReflectances bands_of_reflectances(Vec3f rgb) {
    const float red = std::clamp(rgb.x, 0.0f, 1.0f), green = std::clamp(rgb.y, 0.0f, 1.0f),
                blue = std::clamp(rgb.z, 0.0f, 1.0f);
    constexpr float kDarkest = 1e-4f;
    const float per_red = 1 / std::max(red, kDarkest);
    const float canopy =
        std::clamp(between(green * per_red, kSand[1] / kSand[0], kForest[1] / kForest[0], 0, 1), 0.0f, 1.0f);
    const float snow =
        std::clamp((blue * per_red - 0.6f) / 0.3f, 0.0f, 1.0f) * std::clamp((red - 0.3f) / 0.3f, 0.0f, 1.0f);
    const float soil = std::min(red * kSandInfrared / kSand[0], 0.9f);
    const float plants = kForestInfrared * std::clamp(green / kForest[1], 0.3f, 1.2f);
    const float ground = canopy * plants + (1 - canopy) * soil;
    return {blue, green, red, snow * red * kSnowInfrared / kSnow[0] + (1 - snow) * ground};
}

BandReflectances bands_of_blue_marble(Vec3f rgb) {
    return bands_of_reflectances({power_law(rgb.x, 0), power_law(rgb.y, 1), power_law(rgb.z, 2)});
}

}  // namespace hilcam
