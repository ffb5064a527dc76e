#include "render/scene/body_albedo.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// 2 int p(g) sin g dg over the phase angle, p: geometric albedo times phase function.
Spectrum spherical_albedo(const BodyLook& look) {
    if (look.plain_lambert()) return look.albedo();
    constexpr int kSteps = 180;
    Spectrum sum;
    for (int i = 0; i < kSteps; ++i) {
        const double phase = (i + 0.5) * kPi / kSteps;
        sum += static_cast<float>(2 * std::sin(phase) * kPi / kSteps) * look.disk_albedo(phase);
    }
    return sum;
}

}  // namespace

AirGround body_albedo(const SceneBody& body, const SpectralGrid& grid) {
    const Spectrum albedo = spherical_albedo(body.look);
    if (body.map.empty()) return {1, 1, {albedo}};
    constexpr int kWidth = 64, kHeight = kWidth / 2;
    const ColorBands bands(grid);
    const auto factor = static_cast<float>(body.map_reference > 0 ? 1 / body.map_reference : 1);
    AirGround out{kWidth, kHeight, {}};
    out.albedo.reserve(static_cast<std::size_t>(kWidth * kHeight));
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            constexpr float kCell = 1.0f / kWidth;
            Spectrum here = (factor * albedo) *
                            bands.spectrum(body.map.sample((static_cast<float>(x) + 0.5f) / kWidth,
                                                           (static_cast<float>(y) + 0.5f) / kHeight, kCell));
            // A map may be brighter than its reference; nothing sends up more than it gets.
            for (int b = 0; b < grid.size(); ++b) here[b] = std::min(here[b], 1.0f);
            out.albedo.push_back(here);
        }
    return out;
}

}  // namespace hilcam
