#include "render/background/body_albedo.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Returns 2 int p(g) sin g dg over the phase angle, with p: geometric albedo times phase function.
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
    const ColorBands bands(grid);
    const auto factor = static_cast<float>(body.map_reference > 0 ? 1 / body.map_reference : 1);
    return ground_by_place([&](float u, float v) {
        constexpr float kCell = 1.0f / AirGround::kWidth;
        Spectrum here = (factor * albedo) * bands.spectrum(body.map.sample(u, v, kCell));
        // A map may be brighter than its reference, but nothing reflects more than it receives.
        for (int b = 0; b < grid.size(); ++b) here[b] = std::min(here[b], 1.0f);
        return here;
    });
}

}  // namespace hilcam
