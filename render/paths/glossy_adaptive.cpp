#include "render/paths/glossy_adaptive.h"

#include <algorithm>
#include <cmath>

#include "render/glossy/glossy_reuse.h"

namespace hilcam {
namespace {

// The sensor has this full well [e-], which white paint in the Sun fills, and this noise in the dark [e-].
constexpr float kFullWell_e = 15000, kReadNoise_e = 15;
// Error of a lobe up to which it has no further rays [noises]. With 4, a fifth more of Hubble's blocks in the
// Sun are off by a tenth.
constexpr float kNoises = 3;
// A lobe is judged if its light exceeds this multiple of that error. Without it errors of four scenes are 1 %
// less, and a frame of geo_inspection from 22 m takes a tenth more time.
constexpr float kLight = 3;
constexpr int kMost = 8;  // 16 take twice the time for 1 % less error

// Returns the square of the error that a lobe may have: radiance times samples. The exposure is taken to be one
// for sunlight, in a penumbra, too.
float variance_allowed(const Tile& tile, const GlossyPoint& lobe) {
    const float per_e = tile.white_paint(tile.frame.background->sun_clear_irradiance_w_m2_um()) / kFullWell_e;
    const float dark = kReadNoise_e * per_e;
    return kNoises * kNoises * (dark * dark + per_e * max_component(tile.pixels[lobe.pixel]));
}

// Returns the light that is at stake: the most that the cache, the bodies or one of its rays give the lobe.
float light_at_stake(const GlossyBuffer& buffer, const GlossyPoint& lobe, int x, int y) {
    float most = max_component(lobe.cached);
    for (const Spectrum& body : lobe.bodies) most += max_component(body);
    const float to_pixel = max_component(lobe.weight);
    buffer.for_each_ray(x, y, [&](const GlossyStart& start, const GlossyRay& ray) {
        if (!ray.free && start.on_surface_of(lobe))
            most = std::max(most, to_pixel * max_component(ray.light));
    });
    return lobe.share * most;
}

}  // namespace

int further_rays(const Tile& tile, const GlossyPoint& lobe) {
    // In an eclipse the exposure is unknown, and with it the error that counts: each lobe has as many again.
    if (!(max_component(tile.frame.background->sun_irradiance_w_m2_um()) > 0)) return lobe.sent;
    const int width = tile.box.x1 - tile.box.x0;
    const int x = tile.box.x0 + static_cast<int>(lobe.pixel) % width,
              y = tile.box.y0 + static_cast<int>(lobe.pixel) / width;
    const float allowed = variance_allowed(tile, lobe);
    const float light = light_at_stake(*tile.glossy_frame, lobe, x, y);
    if (!(light * light > kLight * kLight * allowed)) return 0;
    const float error = glossy_error(*tile.glossy_frame, lobe, x, y, tile.box);
    // Variance falls with the number of rays, and neighbours have as many.
    const float more = (error * error / allowed - 1) * static_cast<float>(lobe.sent);
    return more > 0 ? static_cast<int>(std::ceil(std::min(more, static_cast<float>(kMost)))) : 0;
}

}  // namespace hilcam
