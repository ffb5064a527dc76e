#include "render/earth/earth_albedo.h"

#include "render/earth/land.h"
#include "render/earth/sea.h"

namespace hilcam {
namespace {

// Returns the mean over a cell, with equal weights for all maps of a list.
template <class Maps>
EarthSample mean_sample(const Maps& maps, float u, float v, float width) {
    EarthSample sum;
    const auto share = 1 / static_cast<float>(maps.count());
    for (std::size_t i = 0; i < maps.count(); ++i) {
        const EarthSample one = maps.sample(static_cast<double>(i), u, v, width);
        for (std::size_t k = 0; k < sum.value.size(); ++k) sum.value[k] += share * one.value[k];
    }
    return sum;
}

}  // namespace

AirGround earth_albedo(const EarthConfig& config, const GroundMaps& ground, const CloudMaps& clouds,
                       const SpectralGrid& grid) {
    const LandBands land(grid);
    const Sea sea(config.wind_m_s, grid);
    const auto factor = static_cast<float>(config.cloud_thickness);
    return ground_by_place([&](float u, float v) {
        constexpr float kCell = 1.0f / AirGround::kHeight;
        const EarthSample here = mean_sample(ground, u, v, kCell);
        const float cloud =
            thickened_cloud((clouds.empty() ? here : mean_sample(clouds, u, v, kCell)).cloud(), factor);
        const Spectrum albedo = land.reflectance(here) + here.water() * sea.albedo();
        Spectrum both;
        for (int b = 0; b < grid.size(); ++b)
            both[b] = cloud + (1 - cloud) * (1 - cloud) * albedo[b] / (1 - albedo[b] * cloud);
        return both;
    });
}

}  // namespace hilcam
