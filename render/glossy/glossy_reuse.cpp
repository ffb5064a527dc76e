#include "render/glossy/glossy_reuse.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/glossy/glossy_window.h"
#include "render/visibility/place_sequence.h"

namespace hilcam {
namespace {

constexpr float kLeastPixel =
    0.08f;  // weight of pixels that are left out: a third of them, with 5 % of the weight

// Weights of pixels fall to zero at the end of the reach (a tent). So a thing that one ray has met causes no
// edge in the picture, and every place of the pattern has the same weight. Returns the rays of the pixels in
// reach, in `within`, by rows.
class Window {
  public:
    Window(const GlossyBuffer& buffer, const GlossyPoint& at, int x, int y, const PixelBox& within) {
        const float per_px = 1 / static_cast<float>(at.reach_px);
        const auto tent = [&](int off) { return 1 - per_px * static_cast<float>(std::abs(off)); };
        const int reach = at.reach_px - 1;
        for (int row = std::max(within.y0, y - reach); row <= std::min(within.y1 - 1, y + reach); ++row) {
            const float weight = tent(row - y);
            int across = reach;
            while (across >= 0 && weight * tent(across) < kLeastPixel) --across;
            const int x0 = std::max(within.x0, x - across), x1 = std::min(within.x1 - 1, x + across);
            if (x0 > x1) continue;
            buffer.for_each_range(x0, x1, row, [&](std::uint32_t first, std::uint32_t end) {
                if (count_ < ranges_.size()) ranges_[count_++] = {first, end, weight};
            });
        }
    }
    std::span<const GlossyRange> ranges() const { return {ranges_.data(), count_}; }

  private:
    // A row may pass through several parts of the frame.
    std::array<GlossyRange, 4 * (2 * kGlossyPattern_px - 1)> ranges_;
    std::size_t count_ = 0;
};

void weigh(const GlossyBuffer& buffer, const GlossyPoint& at, int x, int y, const PixelBox& within,
           WeighedRays& rays) {
    weigh_rays(buffer.columns(), Window(buffer, at, x, y, within).ranges(), at, x, rays);
}

// Returns how many rays the cache's directions are worth. The directions start at a probe, so they say little
// about things that are nearer than the distance between probes. Without this, narrow strips between Hubble's
// tube and ring have half their light.
float rays_of_cache(const GlossyPoint& at, float per_distance) {
    // With 16 instead of 2, rms of Hubble by the Earth's light is 10.4 instead of 9.9 sensor noises.
    constexpr float kPerDirection = 2;
    constexpr float kWholeFrom = 2;  // full worth from here on [distances between probes]
    const float near = 1 / std::max(kWholeFrom * at.probes_apart_m * per_distance, 1.0f);
    return kPerDirection * near * near * at.directions;
}

}  // namespace

GlossyPlace glossy_place(int x, int y, int ray, int reach_px) {
    // The pixel's number in the window: 2 x 2 pixels have four successive ones, and so on.
    std::uint32_t number = 0;
    for (int bit = reach_px / 2; bit > 0; bit /= 2)
        number = 4 * number + (((x ^ y) & bit) != 0 ? 2u : 0u) + ((y & bit) != 0 ? 1u : 0u);
    constexpr std::uint32_t kMiddle = 1u << 25;  // half of a 64th
    const auto index = static_cast<std::uint32_t>(ray * reach_px * reach_px) + number;
    const auto [u1, u2] = place_in_sequence(index, kMiddle, kMiddle);
    return {u1, u2};
}

float glossy_error(const GlossyBuffer& buffer, const GlossyPoint& at, int x, int y, const PixelBox& within) {
    WeighedRays rays;
    weigh(buffer, at, x, y, within, rays);
    if (!(rays.all > 0)) return at.share * max_component(at.cached);
    // Light of all bodies for a ray that meets nothing, per unit of what it would see of them.
    float bodies = 0, towards = 0;
    for (std::size_t b = 0; b < at.bodies.size(); ++b)
        bodies += max_component(at.bodies[b]), towards += rays.sum.towards[b];
    const float per_towards = towards > 0 ? bodies * rays.all / towards : 0.0f;
    const float to_pixel = max_component(at.weight);
    float of_light = 0, squares = 0, crossed = 0;  // sums of w l, (w l)^2, w^2 l
    for (std::size_t i = 0; i < rays.count; ++i) {
        const float weight = rays.weight[i];
        if (!(weight > 0)) continue;
        const GlossySum& ray = buffer.columns().sum[rays.ray[i]];
        const float light = weight * (to_pixel * ray.brightest() + per_towards * ray.of_bodies());
        of_light += light, squares += light * light, crossed += weight * light;
    }
    // The variance of a ratio estimator (Cochran, Sampling Techniques, 1977, section 6.4). The cache's value
    // counts as one more ray, because a few rays that agree prove little.
    const float mean = of_light / rays.all;
    const float off = max_component(at.cached) - mean;
    const float variance =
        squares - 2 * mean * crossed + mean * mean * rays.squares + rays.squares / rays.rays() * off * off;
    return at.share * std::sqrt(std::max(variance, 0.0f)) / rays.all;
}

GlossyLight reused_light(const GlossyBuffer& buffer, const GlossyPoint& at, int x, int y) {
    WeighedRays rays;
    weigh(buffer, at, x, y, {0, 0, buffer.width(), buffer.height()}, rays);
    const float count = rays.rays();
    // The fewer rays count, the more the cache's directions replace them.
    const float trust =
        count > 0 ? at.share * count * count / (count * count + rays_of_cache(at, rays.per_distance)) : 0.0f;
    GlossyLight out;
    if (rays.all > 0) out.surfaces = (trust / rays.all) * (at.weight * rays.sum.light);
    out.surfaces += (1 - trust) * at.cached;
    for (std::size_t b = 0; b < at.bodies.size(); ++b) {
        // The cache's value counts as one ray.
        const float towards = rays.sum.towards[b], one = towards / std::max(count, 1.0f);
        const float free = towards > 0 ? (rays.sum.free[b] + one * at.free[b]) / (towards + one) : at.free[b];
        out.bodies += (at.share * free + (1 - at.share) * at.free[b]) * at.bodies[b];
    }
    return out;
}

}  // namespace hilcam
