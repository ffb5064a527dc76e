#include "render/earth/earth_albedo.h"

#include "render/earth/land.h"
#include "render/earth/sea.h"

namespace hilcam {
namespace {

// Means over a cell by all maps of a list, each counting alike.
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
    constexpr int kWidth = 64, kHeight = kWidth / 2;
    const LandBands land(grid);
    const Sea sea(config.wind_m_s, grid);
    const auto factor = static_cast<float>(config.cloud_thickness);
    AirGround out{kWidth, kHeight, {}};
    out.albedo.reserve(static_cast<std::size_t>(kWidth * kHeight));
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / kWidth,
                        v = (static_cast<float>(y) + 0.5f) / kHeight;
            constexpr float kCell = 1.0f / kHeight;
            const EarthSample here = mean_sample(ground, u, v, kCell);
            const float cloud =
                thickened_cloud((clouds.empty() ? here : mean_sample(clouds, u, v, kCell)).cloud(), factor);
            const Spectrum albedo = land.reflectance(here) + here.water() * sea.albedo();
            Spectrum& both = out.albedo.emplace_back();
            for (int b = 0; b < grid.size(); ++b)
                both[b] = cloud + (1 - cloud) * (1 - cloud) * albedo[b] / (1 - albedo[b] * cloud);
        }
    return out;
}

}  // namespace hilcam
